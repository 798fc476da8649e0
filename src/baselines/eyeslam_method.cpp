// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/eyeslam_method.h"

namespace eyeslam::baselines {

Mosaic EyeSlamMethod::mosaic() const
{
  Mosaic result;
  result.picture = tracker_.getMosaic(result.origin, result.px_per_pixel);
  return result;
}

}  // namespace eyeslam::baselines
