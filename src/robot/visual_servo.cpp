// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/visual_servo.h"

#include <Eigen/Dense>
#include <stdexcept>
#include <string>

#include "eyeslam/retina/units.h"
#include "eyeslam/robot/tool_jacobian.h"
#include "eyeslam/robot/visp_conversion.h"

namespace eyeslam::robot {

using retina::Reason;

namespace {

bool isFirst(const std::string& word, const char* first, const char* second)
{
  if (word == first) return true;
  if (word == second) return false;
  throw std::runtime_error("visual servo: '" + word + "' is neither " + first + " nor " + second);
}

Eigen::Vector2d toEigen(const vpImagePoint& point) { return {point.get_u(), point.get_v()}; }

bool isRotation(const Eigen::Matrix3d& rotation)
{
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3;
}

bool isPlane(const servo::RetinaPlane& plane)
{
  return plane.normal.allFinite() && std::abs(plane.normal.norm() - 1.0) < 1e-3 && std::isfinite(plane.distance);
}

}  // namespace

VisualServo::VisualServo(const VisualServoOptions& options)
    : options_(options),
      by_image_(isFirst(options.features, "image", "position")),
      of_spot_(!isFirst(options.servoed, "tip", "spot"))
{
  task_.setServo(vpServo::EYETOHAND_L_cVf_fJe);
  task_.setInteractionMatrixType(vpServo::CURRENT);
  task_.setLambda(options.gain_at_zero_hz, options.gain_at_infinity_hz, options.slope_at_zero);
  task_.addFeature(current_, desired_);
  // Features are told in the manipulator's own axes, and fJe speaks of the tip itself: no frame lies between.
  task_.set_cVf(vpHomogeneousMatrix());
}

void VisualServo::setRegistration(const servo::Registration& registration, const servo::RetinaPlane& plane)
{
  registration_ = registration;
  plane_ = plane;
  mm_per_px_ = kMilli * registration.umPerPx(plane).value_or(0.0);
}

void VisualServo::setTarget(const vpImagePoint& target) { target_px_ = toEigen(target); }

void VisualServo::setSeen(const vpImagePoint& seen) { seen_px_ = toEigen(seen); }

std::optional<Eigen::Vector3d> VisualServo::spotOf(const Eigen::Isometry3d& fMe, const servo::RetinaPlane& plane)
{
  const Eigen::Vector3d beam = fMe.linear().col(2);
  const double approach = -plane.normal.dot(beam);
  constexpr double kGrazing = 0.1;  // beyond some 84 degrees from the normal the spot runs away
  if (!(approach > kGrazing)) return std::nullopt;
  return fMe.translation() + beam * (plane.height(fMe.translation()) / approach);
}

// Velocity of the tip, or of the spot, under a twist (v, w) of the tool at its tip, mm/s. The spot is carried by the
// beam and slides along it so that it stays on the plane.
Eigen::Matrix<double, 3, 6> VisualServo::pointMotion(const Eigen::Isometry3d& fMe, const Eigen::Vector3d& point) const
{
  Eigen::Matrix<double, 3, 6> carried;
  carried << Eigen::Matrix3d::Identity(), -crossProduct(point - fMe.translation());
  if (of_spot_) {
    const Eigen::Vector3d beam = fMe.linear().col(2);
    carried -= beam * (plane_.normal.transpose() * carried) / plane_.normal.dot(beam);
  }
  return kPerMilli * carried;
}

Reason VisualServo::look(const Eigen::Isometry3d& fMe, Sight& sight) const
{
  const Eigen::Vector3d tip = fMe.translation();
  const std::optional<Eigen::Vector3d> point = of_spot_ ? spotOf(fMe, plane_) : tip;
  if (!point) return Reason::beam_misses;
  const std::optional<Eigen::Vector3d> goal = registration_.toPlane(*target_px_, plane_);
  if (!goal) return Reason::servo_singular;
  const double standoff = options_.standoff_um * kMicro;
  const Eigen::Matrix<double, 3, 6> motion = pointMotion(fMe, *point);
  if (by_image_) {
    const Eigen::Matrix<double, 2, 3> camera = mm_per_px_ * registration_.image_T_base.leftCols<3>();
    sight.current.head<2>() = mm_per_px_ * *seen_px_;
    sight.desired.head<2>() = mm_per_px_ * *target_px_;
    sight.motion.topRows<2>() = camera * motion / kPerMilli;
  } else if (of_spot_) {
    // The plane's own directions: the spot cannot leave it.
    Eigen::Matrix<double, 2, 3> along;
    along.row(0) = plane_.normal.unitOrthogonal().transpose();
    along.row(1) = plane_.normal.cross(plane_.normal.unitOrthogonal()).transpose();
    sight.current.head<2>() = kPerMilli * along * *point;
    sight.desired.head<2>() = kPerMilli * along * *goal;
    sight.motion.topRows<2>() = along * motion;
  } else {
    sight.current = kPerMilli * tip;
    // As image-based: over the target along the line of sight, at the height that is wanted.
    const servo::RetinaPlane above{plane_.normal, plane_.distance + standoff, 0.0};
    sight.desired = kPerMilli * registration_.toPlane(*target_px_, above).value_or(*goal);
    sight.motion = motion;
    return Reason::none;
  }
  sight.current.z() = kPerMilli * plane_.height(tip);
  sight.desired.z() = kPerMilli * standoff;
  sight.motion.row(2) << kPerMilli * plane_.normal.transpose(), Eigen::RowVector3d::Zero();
  return Reason::none;
}

Reason VisualServo::lawOf(const Sight& sight, const vpMatrix& fJe, Eigen::Vector3d& velocity)
{
  const Eigen::Matrix3d effect = sight.motion * toEigen(fJe);
  const bool finite = effect.allFinite() && sight.current.allFinite() && sight.desired.allFinite();
  if (!finite) return Reason::input_not_finite;
  // Squares of the smallest and the largest effect that a velocity of 1 m/s has.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(effect.transpose() * effect, Eigen::EigenvaluesOnly);
  const double least = options_.least_condition * options_.least_condition * spread.eigenvalues()[2];
  if (!(spread.eigenvalues()[0] > least)) return Reason::servo_singular;
  current_.set_s(sight.current.x(), sight.current.y(), sight.current.z());
  desired_.set_s(sight.desired.x(), sight.desired.y(), sight.desired.z());
  // An interaction matrix is of the camera's motion; here the features move.
  current_.setInteractionMatrix(toVisp(Eigen::MatrixXd(-sight.motion)));
  task_.set_fJe(fJe);
  velocity = toEigen(task_.computeControlLaw());
  error_ = task_.getError();
  return task_.getTaskRank() == 3 && velocity.allFinite() ? Reason::none : Reason::servo_singular;
}

Reason VisualServo::compute(const vpHomogeneousMatrix& fMe, const vpMatrix& fJe, Eigen::Vector3d& velocity)
{
  if (!registration_.good()) return registration_.reason;
  if (!isPlane(plane_) || !(mm_per_px_ > 0.0)) return Reason::surface_unknown;
  if (!registration_.image_T_base.allFinite()) return Reason::input_not_finite;
  if (!target_px_ || (by_image_ && !seen_px_)) return Reason::no_tip;
  if (!target_px_->allFinite() || (by_image_ && !seen_px_->allFinite())) return Reason::input_not_finite;
  if (fJe.getRows() != 6 || fJe.getCols() != 3) return Reason::servo_singular;
  const Eigen::Isometry3d tool = toEigen(fMe);
  if (!tool.matrix().allFinite() || !isRotation(tool.linear())) return Reason::input_not_finite;
  Sight sight;
  if (const Reason why = look(tool, sight); why != Reason::none) return why;
  return lawOf(sight, fJe, velocity);
}

vpColVector VisualServo::computeVelocity(const vpHomogeneousMatrix& fMe, const vpMatrix& fJe)
{
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  try {
    reason_ = compute(fMe, fJe, velocity);
  } catch (const vpException&) {
    reason_ = Reason::internal_error;
  }
  seen_px_.reset();
  if (reason_ != Reason::none) velocity.setZero();
  const double fastest = options_.speed_mm_s * kMilli;
  saturated_ = velocity.norm() > fastest;
  if (saturated_) velocity *= fastest / velocity.norm();
  return toVisp(Eigen::VectorXd(velocity));
}

}  // namespace eyeslam::robot
