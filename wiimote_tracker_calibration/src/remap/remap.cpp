#include "wiimote_tracker_calibration/remap/remap.h"

#include "wiimote_tracker_calibration/remap/error.h"

namespace wiimote_tracker::remap {

const char* nameOf(Model model) {
  switch (model) {
    case Model::kAffine:
      return "affine";
    case Model::kProjective:
      return "projective";
    case Model::kTrilinear:
      return "trilinear";
    default:
      return "thin_plate";
  }
}

Model modelFromName(const std::string& name) {
  for (const Model model :
       {Model::kAffine, Model::kProjective, Model::kTrilinear, Model::kThinPlate}) {
    if (name == nameOf(model))
      return model;
  }
  throw RemapError("\"" + name +
                   "\" is no model of a correction of the volume: choose affine, projective, "
                   "trilinear or thin_plate");
}

}  // namespace wiimote_tracker::remap
