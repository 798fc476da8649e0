// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/tracking/overlay.h"
#include "eyeslam/tracking/tracker_options.h"

namespace eyeslam::apps {

/// Every option of `eyeslam-track`: the tracker's own groups, and those of its pictures.
struct TrackConfiguration {
  tracking::TrackerOptions tracker;
  tracking::OverlayOptions overlay;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    tracking::TrackerOptions::visit(self.tracker, visitor);
    visitor.group("overlay", self.overlay);
  }
};

}  // namespace eyeslam::apps
