// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing but what its target precompiles.
int main() { return 0; }
