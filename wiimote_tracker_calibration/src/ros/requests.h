#pragma once

#include "workflow/reply.h"

#include <wiimote_tracker_msgs/error.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Proof that the node's mutex is locked.
using Lock = std::unique_lock<std::mutex>;

/// A request cannot be done now. what() is one sentence: why, and what to do.
struct Refusal : Error {
  using Error::Error;
};

/// What `work` returns. Anything that it throws becomes a refusal in words.
workflow::Reply replyOf(const std::function<workflow::Reply()>& work);

/// Runs a callback from which nothing may escape; what it throws is logged with this name.
void runCallback(const std::string& name, const std::function<void()>& callback);

/// Scope guard: runs `call` at the end of its scope, also when an exception ends it.
template <typename Call>
struct AtEnd {
  Call call;
  ~AtEnd() { call(); }
};
template <typename Call>
AtEnd(Call) -> AtEnd<Call>;

/// "; first; second".
std::string appendix(const std::vector<std::string>& sentences);

}  // namespace wiimote_tracker
