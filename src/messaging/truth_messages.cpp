// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/truth_messages.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace eyeslam::messaging {
namespace {

template <std::size_t N>
bool finite(const double (&numbers)[N])
{
  return std::all_of(std::begin(numbers), std::end(numbers), [](double number) { return std::isfinite(number); });
}

}  // namespace

retina::Reason Conversion<truth_t>::read(const truth_t& message, truth_t& truth)
{
  const double single[] = {message.um_per_px,  message.retina_theta, message.pivot_error,
                           message.frame_x_px, message.frame_y_px,   message.frame_theta};
  const bool good = finite(single) && finite(message.retina_centre) && finite(message.retina_shift) &&
                    finite(message.tip) && finite(message.null) && finite(message.spot) && finite(message.shaft) &&
                    finite(message.jerked);
  if (!good) return retina::Reason::not_finite;
  if (!(message.um_per_px > 0.0) || message.pivot_error < 0.0 || message.frame < -1)
    return retina::Reason::out_of_range;
  truth = message;
  return retina::Reason::none;
}

}  // namespace eyeslam::messaging
