#include "band_matrix.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::wave {

bool BandMatrix::factorize() {
  const Eigen::Index n = size();
  for (Eigen::Index j = 0; j < n; ++j) {
    if (!(columns_(0, j) > 0.0) || !std::isfinite(columns_(0, j)))
      return false;
    columns_.col(j) /= std::sqrt(columns_(0, j));
    const Eigen::Index reach = std::min(band(), n - 1 - j);
    for (Eigen::Index k = 1; k <= reach; ++k)
      columns_.col(j + k).head(reach - k + 1) -=
          columns_(k, j) * columns_.col(j).segment(k, reach - k + 1);
  }
  return true;
}

void BandMatrix::solveLower(RowMajorMatrix* right) const {
  const Eigen::Index n = size();
  for (Eigen::Index j = 0; j < n; ++j) {
    right->row(j) /= columns_(0, j);
    const Eigen::Index reach = std::min(band(), n - 1 - j);
    for (Eigen::Index k = 1; k <= reach; ++k)
      right->row(j + k) -= columns_(k, j) * right->row(j);
  }
}

void BandMatrix::solveUpper(Eigen::VectorXd* right) const {
  const Eigen::Index n = size();
  for (Eigen::Index j = n - 1; j >= 0; --j) {
    const Eigen::Index reach = std::min(band(), n - 1 - j);
    const double known = columns_.col(j).segment(1, reach).dot(right->segment(j + 1, reach));
    (*right)(j) = ((*right)(j)-known) / columns_(0, j);
  }
}

}  // namespace wiimote_tracker::wave
