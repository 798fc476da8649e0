// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/trajectory_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "eyeslam/files/file_error.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::files {
namespace {

double deviation(double variance) { return std::sqrt(std::max(variance, 0.0)); }

}  // namespace

std::string trajectoryHeader()
{
  return "frame,t_s,tracked,x_px,y_px,theta_deg,scale,sigma_x_px,sigma_y_px,sigma_theta_deg,points,score,reason,cpu_ms,"
         "map_cpu_ms";
}

std::string trajectoryLine(const TrajectoryRow& row)
{
  const tracking::TrackResult& r = row.result;
  const retina::Pose2& pose = r.map_T_frame;
  return fmt::format("{},{:.6f},{},{:.5f},{:.5f},{:.6f},{:.6f},{:.5f},{:.5f},{:.6f},{},{:.4f},{},{:.4f},{:.4f}",
                     row.frame, row.t, r.tracked ? 1 : 0, pose.x, pose.y, pose.theta * kDegreesPerRadian, pose.scale,
                     deviation(r.covariance(0, 0)), deviation(r.covariance(1, 1)),
                     deviation(r.covariance(2, 2)) * kDegreesPerRadian, r.points, r.score, retina::word(r.reason),
                     row.cpu_ms, row.map_cpu_ms);
}

TrajectoryFile::TrajectoryFile(const std::string& path, std::string shown)
    : shown_(std::move(shown)), file_(std::fopen(path.c_str(), "wb"))
{
  if (!file_) fail();
  writeLine(trajectoryHeader());
}

void TrajectoryFile::add(const TrajectoryRow& row) { writeLine(trajectoryLine(row)); }

void TrajectoryFile::writeLine(const std::string& line)
{
  if (std::fprintf(file_.get(), "%s\n", line.c_str()) < 0) fail();
}

void TrajectoryFile::close()
{
  if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0) fail();
  if (std::fclose(file_.release()) != 0) fail();
}

void TrajectoryFile::fail() const
{
  throw FileError(fmt::format("{}: cannot be written: {}", shown_, std::strerror(errno)));
}

}  // namespace eyeslam::files
