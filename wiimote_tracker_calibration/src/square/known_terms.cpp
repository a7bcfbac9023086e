#include "square/known_terms.h"

#include "adjust/corner.h"
#include "adjust/covariance.h"
#include "adjust/gravity.h"
#include "adjust/pixel.h"
#include "adjust/prior.h"
#include "square/lens_priors.h"

namespace wiimote_tracker::square {

void KnownTerms::addPixel(std::size_t camera, const Eigen::Vector2d& pixel, double* place) {
  adjust::CameraBlocks& blocks = cameras_[camera];
  residuals_.push_back(blocks.addTo(
      &problem_, adjust::PixelError(blocks, pixel, stated_.pixel).cost(), nullptr, place));
}

void KnownTerms::addLenses(const std::vector<CameraSightings>& sightings,
                           Eigen::Vector2d* shared_offset) {
  double* const offset = shared_offset->data();
  if (stated_.shared_principal_point > 0.0) {
    add(adjust::priorOf(Eigen::Vector2d::Zero(),
                        Eigen::Vector2d::Constant(stated_.shared_principal_point)),
        offset);
  } else {
    problem_.AddParameterBlock(offset, 2);
    problem_.SetParameterBlockConstant(offset);
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const geometry::Intrinsics& start = sightings[i].intrinsics;
    adjust::LensPrior own = marginalLensPrior(start, stated_);
    own.principal_point = stated_.principal_point;  // given the offset
    if (sharesOffset(start))
      add(adjust::SharedLensPrior{own}.cost(), cameras_[i].lens(), offset);
    else
      add(own.cost(), cameras_[i].lens());
    problem_.SetParameterBlockConstant(cameras_[i].higherDistortion());
  }
}

void KnownTerms::addGravity(const std::vector<CameraSightings>& sightings,
                            const Eigen::Vector3d& up) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!sightings[i].gravity)
      continue;
    add(adjust::GravityError{sightings[i].gravity->normalized(), up, cameras_[i].world_from_start,
                             stated_.gravity}
            .cost(),
        cameras_[i].rotation());
    ++surplus_;  // two directions differ by two angles, in three residuals
  }
}

void KnownTerms::addSquare(const SquareLayout& layout,
                           bool z_up,
                           const std::vector<CameraSightings>& sightings,
                           std::array<Eigen::Vector2d, 4>* corners,
                           std::vector<Eigen::Vector3d>* places) {
  const Corners nominal = layout.corners(z_up);
  for (std::size_t c = 0; c < nominal.size(); ++c) {
    double* const corner = (*corners)[c].data();
    add(adjust::priorOf(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(stated_.placementOf(c))),
        corner);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (const auto& seen = sightings[i].corners[c])
        residuals_.push_back(
            cameras_[i].addTo(&problem_,
                              adjust::CornerPixelError{
                                  adjust::PixelError(cameras_[i], *seen, stated_.pixel), nominal[c]}
                                  .cost(),
                              nullptr, corner));
    }
  }
  if (stated_.unknown_corner)
    surplus_ += 2;  // its prior tells nothing
  while (places->size() < layout.places.size())
    places->push_back(layout.places[places->size()].position);
  for (std::size_t p = 0; p < layout.places.size(); ++p) {
    const KnownPlace& known = layout.places[p];
    double* const place = (*places)[p].data();
    add(adjust::priorOf(known.position, Eigen::Vector3d::Constant(known.stddev)), place);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (p < sightings[i].places.size() && sightings[i].places[p])
        addPixel(i, *sightings[i].places[p], place);
    }
  }
  for (const TapedLength& taped : layout.lengths)
    add(adjust::TapedLengthError{(nominal[taped.to] - nominal[taped.from]).head<2>(), taped.length,
                                 taped.stddev}
            .cost(),
        (*corners)[taped.from].data(), (*corners)[taped.to].data());
}

double KnownTerms::chiSquared() const {
  return adjust::squaresOf(&problem_, residuals_);
}

double KnownTerms::degreesOfFreedom() const {
  return adjust::degreesOfFreedom(&problem_, residuals_) - surplus_;
}

}  // namespace wiimote_tracker::square
