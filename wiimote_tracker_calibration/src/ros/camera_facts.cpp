#include "camera_facts.h"

namespace wiimote_tracker {

workflow::Reply collectFacts(const std::vector<std::string>& names,
                             const std::map<std::string, CameraInput>& inputs,
                             const Parameters& parameters,
                             std::map<std::string, workflow::CameraFacts>* facts) {
  for (const std::string& name : names) {
    const auto found = inputs.find(name);
    if (found == inputs.end())
      continue;
    const CameraInput& input = found->second;
    workflow::CameraFacts fact;
    fact.identity = input.identity;
    fact.intrinsics = parameters.intrinsicsOf(name);
    fact.gravity = input.gravity.mean();
    const bool sized = input.width > 0;
    if (sized && (input.width != fact.intrinsics.width || input.height != fact.intrinsics.height))
      return {false, "the images of " + name + " are " + std::to_string(input.width) + " x " +
                         std::to_string(input.height) + ", but its starting intrinsics are for " +
                         std::to_string(fact.intrinsics.width) + " x " +
                         std::to_string(fact.intrinsics.height) + ": set " +
                         ros::this_node::getName() + "/cameras_intrinsics/" + name +
                         " for this camera"};
    (*facts)[name] = fact;
  }
  return {true, ""};
}

}  // namespace wiimote_tracker
