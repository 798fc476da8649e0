// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as one of the files of a test sequence, the others being right: a FileError or a sequence.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/test_sequence.h"

using namespace eyeslam;

namespace {

class SequenceFolder {
 public:
  SequenceFolder()
  {
    std::string pattern = (std::filesystem::temp_directory_path() / "eyeslam_fuzz_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~SequenceFolder() { std::filesystem::remove_all(path_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ + "/" + name) << text; }

  void reset() const
  {
    write("meta.json", R"({"size": [800, 608], "fps": 30, "frames": 2, "um_per_px": 5.0, "vessels_origin": [0, 0],
                           "rim": null, "condition": "human", "seed": 1, "zoom": 1.0, "burns": []})");
    write("truth.csv",
          "frame,t_s,x_px,y_px,theta_deg,scale,visible,tool_cover\n0,0,0,0,0,1,1,0\n1,0.033,1,2,3,1,1,0\n");
    write("tool.csv", "frame,present,tip_x_px,tip_y_px,shaft_angle_deg,shaft_width_px\n0,0,0,0,0,0\n1,1,5,6,7,8\n");
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static const SequenceFolder folder;
  static constexpr const char* kNames[] = {"meta.json", "truth.csv", "tool.csv"};
  if (size == 0) return 0;
  folder.reset();
  folder.write(kNames[bytes[0] % 3], std::string(bytes + 1, bytes + size));
  try {
    files::readTestSequence(folder.path());
  } catch (const files::FileError&) {
  }
  return 0;
}
