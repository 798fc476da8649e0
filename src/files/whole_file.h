// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eyeslam::files {

/// All bytes of a file. @throws FileError naming it
std::vector<std::uint8_t> readWholeFile(const std::string& path);
std::string readWholeText(const std::string& path);

/// Writes a file from its first to its last byte, and makes sure that they arrived. Not atomic: for what is renamed
/// into place afterwards (OutputFolder).
/// @throws FileError naming it and the cause (no space left, no permission)
void writeWholeFile(const std::string& path, const void* bytes, std::size_t size);
void writeWholeFile(const std::string& path, const std::string& text);

/// SHA-256 of the files' bytes one after another, 64 hexadecimal digits. @throws FileError naming what cannot be read
std::string sha256OfFiles(const std::vector<std::string>& paths);

}  // namespace eyeslam::files
