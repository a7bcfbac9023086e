#include "motion/textbook_imm.h"
#include "motion/transition.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wiimote_tracker::motion {
namespace {

using Eigen::Matrix3d;

TEST(Singer, IsTheSolutionOfItsStochasticDifferentialEquation) {
  for (const double time : {0.2, 1.0, 100.0}) {
    // The halves lie on both sides of where the series end.
    for (const double share : {1e-5, 0.0025, 0.1, 0.4999, 0.5, 2.0, 10.0}) {
      const double duration = share * time;
      SCOPED_TRACE(testing::Message() << time << " s, " << duration << " s");
      const test::Transition truth = test::singerTransition(1.0, time, duration);
      const Transition transition = singer(1.0, time, duration);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          // The exponential of the matrix holds that of the share, which is rounded as a whole.
          const auto near = [share](double expected, double actual) {
            EXPECT_NEAR(expected, actual, 1e-10 * std::exp(share) * std::abs(expected));
          };
          near(truth.F(i, j), transition.F(i, j));
          if (share > 0.001)  // else the exponential of the matrix is the less exact of the two
            near(truth.Q(i, j), transition.Q(i, j));
        }
      }
    }
  }
}

TEST(Singer, OverNoTimeIsTheIdentity) {
  const Transition transition = singer(2.0, 0.3, 0.0);
  EXPECT_EQ(Matrix3d(Matrix3d::Identity()), transition.F);
  EXPECT_EQ(Matrix3d(Matrix3d::Zero()), transition.Q);
}

}  // namespace
}  // namespace wiimote_tracker::motion
