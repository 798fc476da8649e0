// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/retina_messages.h"

int main()
{
  eyeslam::messaging::Link link("memq://", 1, {});
  eyeslam::messaging::Publisher<eyeslam::retina_pose_t> poses(link);
  return poses.publish(eyeslam::messaging::RetinaPose{}, 1, 1) ? 0 : 1;
}
