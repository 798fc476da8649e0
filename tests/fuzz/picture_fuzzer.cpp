// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an encoded picture: an opinion, whatever they are.
#include "eyeslam/files/image_damage.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  std::vector<std::uint8_t> picture(bytes, bytes + size);
  eyeslam::files::damageIn(picture);
  // Behind a right beginning, or the runs would end at the signature.
  const std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  picture.insert(picture.begin(), png.begin(), png.end());
  eyeslam::files::damageIn(picture);
  picture.assign({0xFF, 0xD8, 0xFF});
  picture.insert(picture.end(), bytes, bytes + size);
  eyeslam::files::damageIn(picture);
  return 0;
}
