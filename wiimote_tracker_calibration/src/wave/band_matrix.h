#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_BAND_MATRIX_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_BAND_MATRIX_H

#include <Eigen/Core>

namespace wiimote_tracker::wave {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Symmetric matrix that is zero beyond `band` places off its diagonal, and its Cholesky factor.
class BandMatrix {
 public:
  BandMatrix(Eigen::Index size, Eigen::Index band)
      : columns_(Eigen::MatrixXd::Zero(band + 1, size)) {}

  Eigen::Index size() const { return columns_.cols(); }
  Eigen::Index band() const { return columns_.rows() - 1; }

  /// Element on or below the diagonal, within the band.
  double& operator()(Eigen::Index row, Eigen::Index column) {
    return columns_(row - column, column);
  }

  void setZero() { columns_.setZero(); }

  /// Multiplies the diagonal.
  void scaleDiagonal(double factor) { columns_.row(0) *= factor; }

  /// Replaces the matrix by its lower Cholesky factor L. @returns false if not positive definite.
  bool factorize();

  /// After factorize(): right = L^-1 right.
  void solveLower(RowMajorMatrix* right) const;

  /// After factorize(): right = L^-T right.
  void solveUpper(Eigen::VectorXd* right) const;

 private:
  Eigen::MatrixXd columns_;  // Row k: the elements k places below the diagonal.
};

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_BAND_MATRIX_H
