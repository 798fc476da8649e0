// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "eyeslam/files/picture_file.h"
#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/eye_camera.h"
#include "eyeslam/simulation/fundus_photograph.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/trials/loop_trial.h"

namespace eyeslam::trials {

namespace {

constexpr double kLineStep = 10e-6;  // m
constexpr double kRadius = 20e-6;    // m, of a vessel that a microscope shows clearly
constexpr double kApart = 200e-6;    // m, what a leaning hand may be off (loop study, 1)
// m, for so far a vessel should go on beyond what is traced of it: a hand that leans, drifts and notices late
// overshoots by 0.45 mm at most (20 seeds); less where a retina has no such vessel.
constexpr double kBeyond[] = {450e-6, 300e-6, 150e-6};
constexpr double kLongEnough = 500e-6;         // m, of what is traced
constexpr double kRetina_mm[] = {18.0, 14.0};  // room for a view beside the disc, wherever the eye goes
constexpr double kDiscRoom = 400e-6;           // m
constexpr double kDiscBrightness = 1.3;        // of the mean
constexpr double kSeam = 1.25;                 // of half a view, that must stay on the retina
constexpr double kTurn = 0.2;             // of half a view, so far is the eye turned to get reflections out of the way
constexpr int kTurns = 4;                 // steps of it each way
constexpr double kInView = 0.75;          // of half a view: within it an instrument is seen well
constexpr double kFarthestVessel = 2e-3;  // m, from which no centreline is looked for: the manipulator's reach
constexpr double kEyeMoves = 150e-6;      // m, under reflections that stay

cv::Mat read(const std::string& path, int mode)
{
  return files::readPicture("retina", path, mode, "'procedural', JPEG, PNG or TIFF");
}

simulation::Fundus fundusOf(const TrialSetting& setting, std::uint64_t seed)
{
  const std::string& retina = setting.scenario.retina;
  simulation::ProceduralFundusOptions drawn;
  drawn.width_mm = kRetina_mm[0];
  drawn.height_mm = kRetina_mm[1];
  if (retina == "procedural") return simulation::proceduralFundus(drawn, seed);
  const std::filesystem::path path(retina);
  const std::string mask = (path.parent_path() / (path.stem().string() + "_vessels.png")).string();
  simulation::FundusPhotographOptions options;
  options.um_per_px = setting.scenario.retina_um_per_px;
  const cv::Mat photograph = read(retina, cv::IMREAD_COLOR);  // whose name is the user's: it is complained of first
  return simulation::fundusFromPhotograph(photograph, read(mask, cv::IMREAD_GRAYSCALE), options);
}

// Across the view, left to right.
std::vector<Eigen::Vector3d> straightLine(const Eigen::Vector3d& middle, double length)
{
  std::vector<Eigen::Vector3d> line;
  for (double x = -0.5 * length; x <= 0.5 * length; x += kLineStep)
    line.emplace_back(middle + Eigen::Vector3d(x, 0, 0));
  return line;
}

retina::VesselMap mapOf(const cv::Mat_<float>& calibre_px, double um_per_px)
{
  retina::VesselMap map;
  map.width = calibre_px.cols;
  map.height = calibre_px.rows;
  map.um_per_px = um_per_px;
  map.version = 1;
  cv::Mat_<std::uint8_t> calibre, vessel;
  calibre_px.convertTo(calibre, CV_8U);
  cv::compare(calibre_px, 0.0, vessel, cv::CMP_GT);
  map.calibre_px.assign(calibre.begin(), calibre.end());
  map.probability.assign(vessel.begin(), vessel.end());
  map.seen.assign(map.probability.size(), 255);
  return map;
}

// The disc, where all vessels meet and nobody works, with some room about it.
cv::Mat_<std::uint8_t> brightPlaces(const simulation::Fundus& fundus)
{
  cv::Mat green, smooth;
  cv::extractChannel(fundus.bgr, green, 1);
  const double px = kMicro * fundus.um_per_px;
  const int side = 2 * static_cast<int>(0.5 * kDiscRoom / px) + 1;
  cv::blur(green, smooth, {side, side});
  const double usual = cv::mean(smooth)[0];
  cv::Mat_<std::uint8_t> bright;
  cv::compare(smooth, kDiscBrightness * usual, bright, cv::CMP_GT);
  cv::dilate(bright, bright, cv::Mat::ones(side, side, CV_8U));
  return bright;
}

fixtures::VesselNetwork trueVessels(const simulation::Fundus& fundus)
{
  fixtures::VesselGraph graph;
  graph.update(mapOf(fundus.calibre_px, fundus.um_per_px));
  return graph.network();
}

// @param border  m, around it that no vessel is looked for in
ChosenVessel chosenVessel(const simulation::Fundus& fundus, const fixtures::VesselNetwork& network,
                          const Eigen::Vector2d& border, double longest)
{
  const double px = kMicro * fundus.um_per_px;
  const Eigen::Vector2d size(fundus.calibre_px.cols, fundus.calibre_px.rows);
  const Eigen::Vector2d inset = (border / px).cwiseMin(0.49 * size);
  const cv::Mat_<std::uint8_t> disc = brightPlaces(fundus);
  VesselWish wish{{inset, size - inset}, longest / px, kRadius / px, kApart / px, {}, 0.0};
  wish.um_per_px = fundus.um_per_px;
  wish.excluded = [&disc](const Eigen::Vector2d& at) {
    const cv::Point pixel(cvRound(at.x()), cvRound(at.y()));
    return !cv::Rect({}, disc.size()).contains(pixel) || disc(pixel) != 0;
  };
  ChosenVessel chosen;
  for (const double beyond : kBeyond) {
    wish.beyond_px = beyond / px;
    ChosenVessel other = vesselToTrace(network, wish);
    if (other.centreline.size() > chosen.centreline.size()) chosen = std::move(other);
    if (static_cast<double>(chosen.centreline.size()) * px > kLongEnough) break;  // points are a px apart
  }
  if (chosen.centreline.empty())
    throw std::invalid_argument("retina: no vessel to trace, apart from its neighbours; take another seed");
  return chosen;
}

}  // namespace

TrialScene::TrialScene(const TrialSetting& setting, std::uint64_t seed)
    : fundus_(fundusOf(setting, seed)),
      camera_(setting.hardware.camera),
      um_per_px_(simulation::umPerPx(setting.hardware.camera, seed))
{
  const Scenario& scenario = setting.scenario;
  chooseVessel(1e-3 * scenario.length_mm, scenario.task == "trace", seed);
  const simulation::EyeCamera camera(camera_, fundus_, seed);
  const double px = kMicro * um_per_px_;
  calibre_px_ = camera.vessels();
  cv::Mat vessel;
  cv::compare(calibre_px_, 0.0, vessel, cv::CMP_GT);
  picture_ = {camera.retina(), vessel, {px * camera.vesselsOrigin().x, px * camera.vesselsOrigin().y}, px};
  cv::distanceTransform(255 - picture_.vessel, distance_px_, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const cv::Point2d centre = simulation::imageCentre(camera_);
  middle_ = {px * centre.x, px * centre.y, 0.0};
  const Eigen::Vector3d above(0.0, 0.0, -kMicro * scenario.standoff_um);
  if (scenario.task == "trace") {
    for (Eigen::Vector3d& place : path_) place += middle_ + above;
    return;
  }
  pointed_at_ = 0;
  path_ = {middle_ + above};
  if (scenario.task == "standoff") path_ = straightLine(middle_ + above, std::min(2e-3, 1e-3 * scenario.length_mm));
  if (scenario.task == "hold") path_ = {middle_ + above + workingPlace()};
}

// He puts the middle of the vessel under the microscope, or turns the eye somewhat for what he is to follow; the path
// is about the view's middle, for now.
void TrialScene::chooseVessel(double longest, bool follows_vessel, std::uint64_t seed)
{
  const double px = kMicro * fundus_.um_per_px;
  const Eigen::Vector2d half_view = 0.5 * um_per_px_ * kMicro * Eigen::Vector2d(camera_.width, camera_.height);
  const Eigen::Vector2d border = kSeam * half_view + Eigen::Vector2d::Constant(1e-3 * camera_.reach_mm);
  fixtures::VesselNetwork network = trueVessels(fundus_);
  const ChosenVessel chosen = chosenVessel(fundus_, network, border, longest);
  Eigen::Vector2d view = px * chosen.middle;
  if (camera_.view_x_mm >= 0.0 && camera_.view_y_mm >= 0.0) {
    view = 1e-3 * Eigen::Vector2d(camera_.view_x_mm, camera_.view_y_mm);
  } else {
    if (follows_vessel) view += besideReflections(chosen, half_view, seed);
    camera_.view_x_mm = 1e3 * view.x();
    camera_.view_y_mm = 1e3 * view.y();
  }
  for (const Eigen::Vector2d& place : chosen.centreline) {
    const Eigen::Vector2d from_middle = px * place - view;
    path_.emplace_back(from_middle.x(), from_middle.y(), 0.0);
  }
  pointed_at_ = chosen.clear_at;
  for (fixtures::Vessel& vessel : network.vessels)
    for (fixtures::CenterlinePoint& point : vessel.points) point.position_px -= view / px;
  vessels_ = fixtures::CenterlineIndex(network.vessels, fundus_.um_per_px);
}

// Where the view's middle should lie from the vessel's, so that little of the path and of what a hand leans beyond it
// is out of sight: under reflections, which stay while the eye is turned, or near the view's border, where the
// instrument is lost.
Eigen::Vector2d TrialScene::besideReflections(const ChosenVessel& chosen, const Eigen::Vector2d& half_view,
                                              std::uint64_t seed) const
{
  const simulation::SpecularBlooms blooms = simulation::specularBlooms(camera_, seed);
  const double px = kMicro * um_per_px_;
  const cv::Point2d centre = simulation::imageCentre(camera_);
  const auto hidden = [&](const Eigen::Vector2d& view) {
    std::size_t count = 0;
    for (const Eigen::Vector2d& place : chosen.leaned_on) {
      const Eigen::Vector2d seen = kMicro * fundus_.um_per_px * (place - chosen.middle) - view;
      const bool outside = (seen.cwiseAbs().array() > kInView * half_view.array()).any();
      const cv::Point2d at = centre + cv::Point2d(seen.x() / px, seen.y() / px);
      count += outside || blooms.mayHide(at, kEyeMoves / px);
    }
    return count;
  };
  std::vector<Eigen::Vector2d> views;
  for (int y = -kTurns; y <= kTurns; ++y)
    for (int x = -kTurns; x <= kTurns; ++x)
      views.emplace_back(kTurn * half_view.cwiseProduct(Eigen::Vector2d(x, y)) / kTurns);
  std::stable_sort(views.begin(), views.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  const auto hides_less = [&](const auto& a, const auto& b) { return hidden(a) < hidden(b); };
  return *std::min_element(views.begin(), views.end(), hides_less);
}

Eigen::Vector2d TrialScene::pixelOf(const Eigen::Vector2d& place) const
{
  return (place - picture_.origin) / picture_.m_per_px;
}

double TrialScene::widestWithin(const Eigen::Vector2d& place, double radius) const
{
  const Eigen::Vector2d at = pixelOf(place);
  const int reach = static_cast<int>(std::ceil(radius / picture_.m_per_px));
  const cv::Rect whole({}, calibre_px_.size());
  float widest = 0.0F;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const cv::Point pixel(cvRound(at.x()) + x, cvRound(at.y()) + y);
      const double distance = std::hypot(pixel.x - at.x(), pixel.y - at.y()) * picture_.m_per_px;
      if (whole.contains(pixel) && distance <= radius) widest = std::max(widest, calibre_px_(pixel));
    }
  }
  return static_cast<double>(widest) * picture_.m_per_px;
}

double TrialScene::vesselDistance(const Eigen::Vector2d& place) const
{
  const Eigen::Vector2d at = pixelOf(place);
  const cv::Point pixel(std::clamp(cvRound(at.x()), 0, distance_px_.cols - 1),
                        std::clamp(cvRound(at.y()), 0, distance_px_.rows - 1));
  // Half a px: from a cell's centre to the edge that both share.
  return std::max(0.0, static_cast<double>(distance_px_(pixel)) - 0.5) * picture_.m_per_px;
}

double TrialScene::centrelineDistance(const Eigen::Vector2d& place) const
{
  const auto nearest = vessels_.nearest(place - middle_.head<2>(), kFarthestVessel);
  return nearest ? nearest->distance : std::numeric_limits<double>::infinity();
}

retina::VesselMap TrialScene::trueMap() const
{
  retina::VesselMap map = mapOf(calibre_px_, um_per_px_);
  map.origin_x = picture_.origin.x() / picture_.m_per_px;
  map.origin_y = picture_.origin.y() / picture_.m_per_px;
  return map;
}

}  // namespace eyeslam::trials
