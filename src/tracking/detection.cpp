// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/detection.h"

namespace eyeslam::tracking {

namespace {

class RidgeDetection : public VesselDetector {
 public:
  explicit RidgeDetection(const TrackerOptions& options) : ridges_(options.ridge), spurious_(options.spurious) {}

  void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) override
  {
    ridges_.detect(frame, mask, points);
    spurious_.removeFrom(points, frame, mask);
  }

 private:
  RidgeDetector ridges_;
  SpuriousDetectionFilter spurious_;
};

class TracingDetection : public VesselDetector {
 public:
  explicit TracingDetection(const TrackerOptions& options)
      : tracer_(options.tracer), spurious_(options.spurious), smoother_(options.smoother)
  {}

  void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) override
  {
    tracer_.detect(frame, mask, points);
    spurious_.removeFrom(points, frame, mask);
    smoother_.smoothAcross(points, frame, mask);
  }

 private:
  VesselTracer tracer_;
  SpuriousDetectionFilter spurious_;
  CrossVesselSmoother smoother_;
};

}  // namespace

std::unique_ptr<VesselDetector> makeDetector(const TrackerOptions& options)
{
  if (options.detector == "tracing") return std::make_unique<TracingDetection>(options);
  return std::make_unique<RidgeDetection>(options);
}

}  // namespace eyeslam::tracking
