// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/operator_watch.h"

namespace eyeslam::servo {

const Wish& OperatorWatch::update(std::int64_t monotonic) noexcept
{
  wish_.rearmed = false;
  const messaging::OperatorWish* said = ears_.operators.latest();
  if (said) {
    const std::int64_t session = ears_.operators.header().session;
    wish_ = {static_cast<Mode>(said->mode), said->stop, session == session_ && said->rearmed > rearmed_};
    session_ = session;
    rearmed_ = said->rearmed;
  }
  if (ears_.operators.silence(monotonic) > silence_) ears_.operators.acceptNewSession();
  return wish_;
}

}  // namespace eyeslam::servo
