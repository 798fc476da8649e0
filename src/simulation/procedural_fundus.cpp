// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/procedural_fundus.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/simulation/noise_field.h"
#include "eyeslam/simulation/vessel_drawing.h"

namespace eyeslam::simulation {

namespace {

// Means over HRF photographs, BGR, white = 1.
const cv::Vec3f kRetina(0.118F, 0.235F, 0.745F);
const cv::Vec3f kDisc(0.38F, 0.64F, 0.98F);
const cv::Vec3f kDiscRim(0.29F, 0.54F, 1.0F);
// Absorption by blood, per um of its depth, BGR: thick vessels in HRF keep 0.83, 0.6 and 0.935 of the light.
const cv::Vec3f kVenous(0.0028F, 0.0080F, 0.0014F);
const cv::Vec3f kArterial(0.0021F, 0.0066F, 0.0006F);
// Where what fovea and disc add is lost in rounding, to the bit: not computed there.
constexpr double kFarFromFovea_um = 2200.0;
constexpr double kFarFromDisc = 1.6;  // of its radius

struct Layers {
  cv::Mat_<float> broad;    // pigment over mm
  cv::Mat_<float> mottled;  // pigment over some 100 um
  cv::Mat_<float> grain;    // the finest
  cv::Mat_<float> choroid;  // ridges of the choroid's vessels
  cv::Mat_<float> hue;      // slow change of colour
};

RetinaPlan plan(const ProceduralFundusOptions& options, Random& random)
{
  RetinaPlan result;
  result.extent = 1000.0 * Eigen::Vector2d(options.width_mm, options.height_mm);
  // 4.5 mm from disc to fovea, which lies 0.4 mm lower; a right eye or a left one.
  const double side = random.chance(0.5) ? 1.0 : -1.0;
  const Eigen::Vector2d middle =
      0.5 * result.extent + Eigen::Vector2d(random.uniform(-400, 400), random.uniform(-300, 300));
  result.disc = middle + Eigen::Vector2d(-side * 2700.0, -150.0);
  result.fovea = middle + Eigen::Vector2d(side * 1800.0, 250.0);
  result.disc_radius = random.uniform(780.0, 920.0);
  return result;
}

// Lines where a smooth noise changes its sign look like a net of wide vessels.
cv::Mat_<float> choroidOf(cv::Size size, double um_per_px, Random& random)
{
  const cv::Mat_<float> a = fractalNoise(size, 700.0 / um_per_px, 2, 0.5, random);
  const cv::Mat_<float> b = fractalNoise(size, 520.0 / um_per_px, 2, 0.5, random);
  cv::Mat_<float> net(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      net(y, x) = std::exp(-6.0F * a(y, x) * a(y, x)) + 0.8F * std::exp(-6.0F * b(y, x) * b(y, x)) - 0.75F;
    }
  }
  return net;
}

Layers layersOf(cv::Size size, double um_per_px, Random& random)
{
  return {fractalNoise(size, 2400.0 / um_per_px, 2, 0.6, random),
          fractalNoise(size, 420.0 / um_per_px, 4, 0.72, random), fractalNoise(size, 42.0 / um_per_px, 3, 0.85, random),
          choroidOf(size, um_per_px, random), fractalNoise(size, 1500.0 / um_per_px, 3, 0.6, random)};
}

// Nerve fibres run away from the disc and arch over the macula: noise drawn out along their way.
cv::Mat_<float> fibresOf(const RetinaPlan& plan, cv::Size size, double um_per_px, Random& random)
{
  const cv::Mat_<float> noise = smoothNoise({1440, 96}, 2.4, random);
  cv::Mat_<float> fibres(size, 0.0F);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double dx = x * um_per_px - plan.disc.x();
      const double dy = y * um_per_px - plan.disc.y();
      const double distance = std::hypot(dx, dy);
      const double fade = std::exp(-distance / 2200.0) * retina::smoothstep((distance - plan.disc_radius) / 500.0);
      if (fade < 0.02) continue;
      const double direction = std::atan2(dy, dx);
      const double turn = direction + 0.25 * std::sin(2.0 * direction) * distance / 4000.0;
      const auto u = static_cast<float>((turn / 6.2832 + 0.55) * 1300.0);
      const auto v = static_cast<float>(std::min(distance / 110.0, 90.0));
      const int iu = std::clamp(static_cast<int>(u), 0, noise.cols - 2);
      const int iv = std::clamp(static_cast<int>(v), 0, noise.rows - 2);
      const float fu = u - static_cast<float>(iu);
      const float fv = v - static_cast<float>(iv);
      const float above = noise(iv, iu) * (1.0F - fu) + noise(iv, iu + 1) * fu;
      const float below = noise(iv + 1, iu) * (1.0F - fu) + noise(iv + 1, iu + 1) * fu;
      fibres(y, x) = static_cast<float>(fade) * (above * (1.0F - fv) + below * fv);
    }
  }
  return fibres;
}

// What a pixel of the layers below the vessels looks like.
class Ground {
 public:
  Ground(const RetinaPlan& plan, const ProceduralFundusOptions& options, cv::Size size, Random& random)
      : plan_(plan),
        options_(options),
        layers_(layersOf(size, options.um_per_px, random)),
        fibres_(fibresOf(plan, size, options.um_per_px, random)),
        tilt_(random.uniform(-0.3, 0.3)),
        cup_(random.uniform(0.35, 0.6)),
        green_(static_cast<float>(random.uniform(0.9, 1.25))),
        blue_(static_cast<float>(random.uniform(0.8, 1.25)))
  {}

  cv::Vec3f at(int x, int y) const
  {
    const Eigen::Vector2d place = options_.um_per_px * Eigen::Vector2d(x, y);
    const double macula = (place - plan_.fovea).norm();
    const double wide = 0.30 * std::exp(-macula * macula / (2.0 * 900.0 * 900.0));
    const double dark =
        macula > kFarFromFovea_um ? wide : wide + 0.16 * std::exp(-macula * macula / (2.0 * 220.0 * 220.0));
    const double pigment =
        options_.texture * (0.05 * layers_.broad(y, x) + 0.028 * layers_.mottled(y, x) + 0.022 * layers_.grain(y, x)) +
        options_.choroid * 0.035 * layers_.choroid(y, x);
    const double fibre = options_.texture * 0.05 * fibres_(y, x);
    const auto hue = static_cast<float>(0.022 * options_.texture * layers_.hue(y, x));
    const double red = std::exp(0.85 * pigment + 0.3 * fibre - 0.35 * dark);
    const double green = std::exp(pigment + fibre - dark);
    const double blue = std::exp(1.1 * pigment + 1.2 * fibre - 0.9 * dark);
    cv::Vec3f colour(kRetina[0] * blue_ * static_cast<float>(blue) * (1.0F - hue),
                     kRetina[1] * green_ * static_cast<float>(green) * (1.0F + hue),
                     kRetina[2] * static_cast<float>(red));
    return withDisc(colour, place, pigment);
  }

 private:
  cv::Vec3f withDisc(cv::Vec3f colour, const Eigen::Vector2d& place, double pigment) const
  {
    // A disc is taller than wide, with a paler cup; a dark crescent of pigment lies at its temporal edge.
    const Eigen::Vector2d offset = (place - plan_.disc).cwiseQuotient(Eigen::Vector2d(0.93, 1.06)) / plan_.disc_radius;
    if (offset.squaredNorm() > kFarFromDisc * kFarFromDisc) return colour;
    const double wavy = offset.norm() * (1.0 + 0.03 * std::sin(3.0 * std::atan2(offset.y(), offset.x()) + 5.0 * tilt_));
    const double towards_fovea = offset.x() * (plan_.fovea.x() > plan_.disc.x() ? 1.0 : -1.0);
    const double crescent =
        std::exp(-std::pow((wavy - 1.07) / 0.07, 2)) * std::clamp(0.4 + 0.8 * towards_fovea, 0.0, 1.0);
    colour *= static_cast<float>(1.0 - 0.18 * crescent);
    const double inside = retina::smoothstep((1.06 - wavy) / 0.12);
    if (inside <= 0.0) return colour;
    const double cup = retina::smoothstep((cup_ + 0.15 - (offset - Eigen::Vector2d(0.12, 0.0)).norm()) / 0.3);
    const auto pale = static_cast<float>((0.92 + 0.1 * offset.x() * tilt_ + 0.15 * cup) * std::exp(0.5 * pigment));
    const cv::Vec3f rim = 0.25F * colour + 0.75F * kDiscRim;
    const cv::Vec3f disc = pale * (static_cast<float>(1.0 - cup) * rim + static_cast<float>(cup) * kDisc);
    return colour + static_cast<float>(inside) * (disc - colour);
  }

  RetinaPlan plan_;
  ProceduralFundusOptions options_;
  Layers layers_;
  cv::Mat_<float> fibres_;
  double tilt_, cup_;
  float green_, blue_;
};

// Beer and Lambert: blood takes its share of the light on its way; the reflex gives some back.
cv::Vec3f throughBlood(cv::Vec3f colour, float artery_um, float vein_um, float reflex)
{
  for (int c = 0; c < 3; ++c) {
    const float kept = std::exp(-kArterial[c] * artery_um - kVenous[c] * vein_um);
    colour[c] *= kept + (1.0F - kept) * 0.55F * reflex;
  }
  return colour;
}

}  // namespace

Fundus proceduralFundus(const ProceduralFundusOptions& options, std::uint64_t seed)
{
  Random random(seed, 20);
  const RetinaPlan retina = plan(options, random);
  const cv::Size size(cvRound(retina.extent.x() / options.um_per_px), cvRound(retina.extent.y() / options.um_per_px));
  VesselPictures vessels = drawVessels(growVessels(retina, options.vessels, seed), size, options.um_per_px);
  // Nothing in an eye is sharper than its optics.
  const double blur_px = 5.0 / options.um_per_px;
  for (cv::Mat_<float>* picture : {&vessels.artery_um, &vessels.vein_um, &vessels.reflex}) {
    cv::GaussianBlur(*picture, *picture, {}, std::max(0.4, blur_px));
  }
  const Ground ground(retina, options, size, random);
  Fundus fundus;
  fundus.um_per_px = options.um_per_px;
  fundus.bgr.create(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      fundus.bgr(y, x) =
          throughBlood(ground.at(x, y), vessels.artery_um(y, x), vessels.vein_um(y, x), vessels.reflex(y, x));
    }
  }
  fundus.calibre_px = vessels.calibre_px;
  fundus.known = cv::Mat_<std::uint8_t>(size, std::uint8_t{255});
  return fundus;
}

}  // namespace eyeslam::simulation
