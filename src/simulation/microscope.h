// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/simulation/illumination.h"
#include "eyeslam/simulation/instrument.h"
#include "eyeslam/simulation/laser_burns.h"
#include "eyeslam/simulation/sensor.h"
#include "eyeslam/simulation/specular_blooms.h"
#include "eyeslam/simulation/view_motion.h"

namespace eyeslam::simulation {

struct OpticsOptions {
  double exposure_ms = 15.0;
  double defocus_px = 1.0;
  double defocus_change_px = 0.3;
  double veil = 0.0;
  double white_red = 1.0;
  double white_green = 1.0;
  double white_blue = 1.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("exposure_ms", self.exposure_ms, Range{0, 1000}, "ms",
                  "how long a frame collects light; source: our choice, half a frame at 30 Hz");
    visitor.field("defocus_px", self.defocus_px, Range{0, 20}, "px of a view 800 px wide",
                  "sigma of the blur of the retina; source: our choice, by eye");
    visitor.field("defocus_change_px", self.defocus_change_px, Range{0, 20}, "px of a view 800 px wide",
                  "by which it slowly changes; source: our choice");
    visitor.field("veil", self.veil, Range{0, 1}, "of white",
                  "stray light over the whole field; source: our choice, by eye");
    visitor.field("white_red", self.white_red, Range{0, 4}, "", "gain of red; source: our choice, by eye");
    visitor.field("white_green", self.white_green, Range{0, 4}, "", "gain of green; source: our choice, by eye");
    visitor.field("white_blue", self.white_blue, Range{0, 4}, "", "gain of blue; source: our choice, by eye");
  }
};

struct MicroscopeOptions {
  OpticsOptions optics;
  IlluminationOptions illumination;
  SpecularBloomsOptions blooms;
  InstrumentOptions instrument;
  LaserBurnsOptions laser;
  SensorOptions sensor;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.group("optics", self.optics);
    visitor.group("illumination", self.illumination);
    visitor.group("blooms", self.blooms);
    visitor.group("instrument", self.instrument);
    visitor.group("laser", self.laser);
    visitor.group("sensor", self.sensor);
  }
};

/// One frame and its truth.
struct RenderedFrame {
  int frame = 0;
  double t_s = 0.0;
  cv::Mat_<cv::Vec3b> image;
  retina::Pose2 map_T_frame;  ///< at mid-exposure, px (contracts, section 1)
  bool visible = true;        ///< the retina can be seen
  double tool_cover = 0.0;    ///< share of the picture that the shaft hides
  InstrumentPose tool;        ///< px
  bool fired = false;         ///< a pulse began
};

/// Instrument and laser light in a frame, mean over its exposure; frame px.
struct ToolInView {
  InstrumentPose tool;  ///< a shaft without width takes the microscope's
  cv::Point2d spot;     ///< where the beam meets the retina
  double aiming = 0.0;  ///< share of the exposure in which the aiming beam is on, [0, 1]
  double flash = 0.0;   ///< the same of the treatment beam
};

/// Looks at a canvas and makes frames of it.
class Microscope {
 public:
  struct View {
    cv::Size size;
    double px_scale = 1.0;  ///< multiplies all lengths in the options: width / 800
    double fps = 30.0;
    double duration_s = 1.0;
  };

  /// @param canvas      the retina, CV_32FC4, white = 1; burns are painted into it
  /// @param map_origin  map coordinates of the canvas's pixel (0, 0), px
  Microscope(const MicroscopeOptions& options, const View& view, cv::Mat canvas, cv::Point2d map_origin,
             std::uint64_t seed);

  /// The frame whose exposure is centred at frame / fps. Call with growing numbers: burns stay.
  RenderedFrame expose(int frame, const ViewMotion& motion);
  /// The same with an instrument and a laser that others move.
  RenderedFrame expose(int frame, const ViewMotion& motion, const ToolInView& seen);
  /// Turns the retina white around a place of the map, px; it stays so.
  void burn(cv::Point2d place_map);
  const Illumination& illumination() const { return illumination_; }

 private:
  void exposeRetina(double t_s, const ViewMotion& motion);
  void defocus(double t_s);
  void begin(int frame, const ViewMotion& motion, RenderedFrame& result);
  void light(double t_s, RenderedFrame& result);
  void read(RenderedFrame& result);
  void fire(RenderedFrame& result);

  OpticsOptions optics_;
  View view_;
  Illumination illumination_;
  SpecularBlooms blooms_;
  Instrument instrument_;
  LaserBurns laser_;
  Sensor sensor_;
  cv::Mat canvas_;
  cv::Point2d map_origin_;
  double focus_phase_;
  cv::Mat picture_;  // CV_32FC4
  cv::Mat_<float> light_;
};

}  // namespace eyeslam::simulation
