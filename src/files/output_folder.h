// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace eyeslam::files {

/// A folder of results that appears as a whole: all is written beside and renamed into place by `publish`. A folder
/// that did not exist appears at once; in one that did, each file and the folder `map` are replaced one by one,
/// `run.json` last, and files of other people stay.
class OutputFolder {
 public:
  /// @param path   the folder; it and its parents are made when missing
  /// @param owned  names that a run may write; those an earlier run left are removed when this one does not write them
  /// @throws FileError when it cannot be written, or is no folder
  OutputFolder(const std::string& path, std::vector<std::string> owned);
  /// Unpublished: removes everything it made.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where `name` ("map/map_000012.png") is written until it is published.
  std::string staged(const std::string& name) const { return (staging_ / name).string(); }
  /// Where `name` will be, for messages.
  std::string final(const std::string& name) const { return (folder_ / name).string(); }

  /// Write one staged file. @throws FileError naming its final place
  void write(const std::string& name, const std::string& text) const;
  void writePng(const std::string& name, const cv::Mat& image) const;

  /// @throws FileError when the disk is as good as full: encoders of video do not say so
  void checkSpace() const;

  /// Renames everything into place. @throws FileError
  void publish();

 private:
  void makeParents();
  void removeParents() const;
  void removeLeftovers() const;
  void moveIntoPlace(const std::string& name) const;

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::vector<std::string> owned_;
  std::vector<std::filesystem::path> made_parents_;
  bool existed_ = false;
  bool published_ = false;
};

}  // namespace eyeslam::files
