#include "motion_steps.h"

#include "wiimote_tracker_triangulation/motion/singer_step.h"

namespace wiimote_tracker::motion {

KinematicSteps motionSteps(const MotionOptions& options, double duration) {
  KinematicSteps steps;
  steps.p_v = duration;
  const Wandering* wanderings[] = {&options.smooth, &options.gentle, &options.brisk};
  for (int i = 0; i < 3; ++i) {
    const SingerStep step(duration, wanderings[i]->time);
    const double variance = wanderings[i]->stddev * wanderings[i]->stddev;
    steps.p_a[i] = step.p_a;
    steps.v_a[i] = step.v_a;
    steps.a_a[i] = step.a_a;
    steps.noise_pp[i] = variance * step.q_pp;
    steps.noise_pv[i] = variance * step.q_pv;
    steps.noise_pa[i] = variance * step.q_pa;
    steps.noise_vv[i] = variance * step.q_vv;
    steps.noise_va[i] = variance * step.q_va;
    steps.noise_aa[i] = variance * step.q_aa;
  }
  // The velocity is a random walk; there is no acceleration to speak of.
  const double density = options.sudden_random_walk * options.sudden_random_walk;
  steps.p_a[3] = 0.0;
  steps.v_a[3] = 0.0;
  steps.a_a[3] = 0.0;
  steps.noise_pp[3] = density * duration * duration * duration / 3.0;
  steps.noise_pv[3] = density * duration * duration / 2.0;
  steps.noise_vv[3] = density * duration;
  steps.noise_pa[3] = 0.0;
  steps.noise_va[3] = 0.0;
  steps.noise_aa[3] = 0.0;
  return steps;
}

}  // namespace wiimote_tracker::motion
