// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/messaging/conversion.h"
#include "eyeslam/registration_t.hpp"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo_status_t.hpp"

namespace eyeslam::messaging {

/// The retina as a plane in the manipulator's frame: normal . point = offset; m.
struct PublishedPlane {
  bool known = false;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from the retina towards the instrument
  double offset = 0.0;
  double residual = 0.0;  ///< RMS of the points that it was fitted to
};

/// The camera in the manipulator's frame, for everyone to use one scale (REGISTRATION).
struct PublishedRegistration {
  bool valid = false;
  retina::Reason reason = retina::Reason::none;                                           ///< why not
  std::int64_t samples = 0;                                                               ///< tips that it rests on
  Eigen::Matrix<double, 2, 4> image_T_manipulator = Eigen::Matrix<double, 2, 4>::Zero();  ///< px/m and, last, px
  Eigen::Matrix4d row_covariance = Eigen::Matrix4d::Zero();  ///< of either row; the rows are independent
  double residual_px = 0.0;                                  ///< RMS, full-resolution px
  double condition = 0.0;                                    ///< of the fit; 0 = not known
  double um_per_px = 0.0;                                    ///< of full-resolution map px; 0 = unknown
  PublishedPlane plane;
};

enum class ServoState { standby, ready, assist, laser, hold, fault };
std::string_view word(ServoState state);

/// What the servo does and how well (SERVO_STATUS); s, -1 where nothing has come yet.
struct ServoStatus {
  ServoState state = ServoState::standby;
  retina::Reason reason = retina::Reason::none;  ///< why not in the wanted state
  std::int64_t map_id = 0;                       ///< of the pose in use; 0 = none
  bool real_time = false;                        ///< scheduled in real time with its memory locked
  double pose_age = -1.0;                        ///< since mid-exposure of the newest pose used
  double state_age = -1.0;                       ///< since the newest MICRON_STATE was received
  double laser_age = -1.0;                       ///< since the newest LASER_STATE was received
  double operator_age = -1.0;                    ///< since the newest OPERATOR was received
  double frame_to_command = -1.0;                ///< from mid-exposure to the first command that used the frame
  double computation = 0.0;                      ///< CPU time of the longest command since the last status
  double lateness = 0.0;                         ///< latest start of a cycle since the last status
  std::int64_t cycles = 0;                       ///< since the start
  std::int64_t overruns = 0;                     ///< cycles left out because the one before took too long
  std::int64_t messages_lost = 0;                ///< on all channels it listens to
  Refusals messages_refused{};                   ///< on all channels
};

template <>
struct Conversion<registration_t> : ListedConversion<registration_t, PublishedRegistration> {};
template <>
struct Conversion<servo_status_t> : ListedConversion<servo_status_t, ServoStatus> {};

}  // namespace eyeslam::messaging
