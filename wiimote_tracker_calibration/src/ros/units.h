#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_UNITS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_UNITS_H

#include "input_queue.h"
#include "node_context.h"

#include <memory>

namespace wiimote_tracker {

/// A subject of the node: an object that offers services and subscribes to the context's inputs.
/// The context must outlive it.
using Unit = std::shared_ptr<void>;

/// Files: save and load (the rig), save_samples and load_samples (what was captured), and join (the
/// rig with another room's).
Unit fileServices(NodeContext* context);

/// What is captured, the square and the wave: check_connection, start, capture_corner,
/// measure_length, start_wave, stop_wave, hands_free, undo, cancel; and button A of a hand-held
/// remote, which captures.
Unit captureServices(NodeContext* context);

/// Lights that are not the LED: learn_masks, clear_masks.
Unit maskServices(NodeContext* context);

/// From what was captured to a rig and its verdict: solve; topic principal_point_trace.
Unit solveServices(NodeContext* context);

/// A camera's lens from the 16-LED board: board/start, board/undo, board/cancel, board/solve,
/// board/commit, and the topic board. Independent of the calibration's steps.
Unit boardServices(NodeContext* context);

/// A still LED on a known place: check, measure_place, and known_places/add, undo, clear, fit.
Unit placeServices(NodeContext* context);

/// Solves one camera against the others, or adds it: recalibrate_camera. Removes one:
/// remove_camera.
Unit recalibrateServices(NodeContext* context);

/// A rig that corrects itself from ordinary tracking: continuous/apply, continuous/revert.
/// @param of_one_led what the health monitor hands on.
Unit continuousServices(NodeContext* context, InputQueue* of_one_led);

/// Reports cameras of the current rig that were moved, and cameras that it lacks: in the status, in
/// /diagnostics, and once in the log. It never changes the rig.
/// @param of_one_led gets what the cameras sent: of several LEDs images show one.
Unit healthMonitor(NodeContext* context, InputQueue* of_one_led);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_UNITS_H
