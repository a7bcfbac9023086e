#include "wiimote_tracker_triangulation/motion/motion_steps.h"

#include "wiimote_tracker_triangulation/motion/singer_step.h"

namespace wiimote_tracker::motion {

const KinematicSteps& MotionSteps::over(double duration) {
  if (duration == duration_)
    return steps_;
  duration_ = duration;
  steps_.p_v = duration;
  const Wandering* wanderings[] = {&options_.smooth, &options_.gentle, &options_.brisk};
  for (int i = 0; i < 3; ++i) {
    const SingerStep step(duration, wanderings[i]->time);
    const double variance = wanderings[i]->stddev * wanderings[i]->stddev;
    steps_.p_a[i] = step.p_a;
    steps_.v_a[i] = step.v_a;
    steps_.a_a[i] = step.a_a;
    steps_.noise_pp[i] = variance * step.q_pp;
    steps_.noise_pv[i] = variance * step.q_pv;
    steps_.noise_pa[i] = variance * step.q_pa;
    steps_.noise_vv[i] = variance * step.q_vv;
    steps_.noise_va[i] = variance * step.q_va;
    steps_.noise_aa[i] = variance * step.q_aa;
  }
  // The velocity is a random walk; there is no acceleration to speak of.
  const double density = options_.sudden_random_walk * options_.sudden_random_walk;
  steps_.p_a[3] = 0.0;
  steps_.v_a[3] = 0.0;
  steps_.a_a[3] = 0.0;
  steps_.noise_pp[3] = density * duration * duration * duration / 3.0;
  steps_.noise_pv[3] = density * duration * duration / 2.0;
  steps_.noise_vv[3] = density * duration;
  steps_.noise_pa[3] = 0.0;
  steps_.noise_va[3] = 0.0;
  steps_.noise_aa[3] = 0.0;
  return steps_;
}

}  // namespace wiimote_tracker::motion
