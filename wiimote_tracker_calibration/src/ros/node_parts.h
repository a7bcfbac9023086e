#pragma once

#include "input_queue.h"
#include "node_context.h"

#include <memory>

namespace wiimote_tracker {

/// A subject of the node: an object that offers services and subscribes to the context's inputs.
/// The context must outlive it.
using NodePart = std::shared_ptr<void>;

/// Files: save and load (the rig), save_samples and load_samples (what was captured), and join (the
/// rig with another room's).
NodePart fileServices(NodeContext* context);

/// What is captured, the square and the wave: check_connection, start, capture_corner,
/// measure_length, start_wave, stop_wave, hands_free, undo, cancel; and button A of a hand-held
/// remote, which captures.
NodePart captureServices(NodeContext* context);

/// Lights that are not the LED: learn_masks, clear_masks.
NodePart maskServices(NodeContext* context);

/// From what was captured to a rig and its verdict: solve; topic principal_point_trace.
NodePart solveServices(NodeContext* context);

/// A camera's lens from the 16-LED board: board/start, board/undo, board/cancel, board/solve,
/// board/commit, and the topic board. Independent of the calibration's steps.
NodePart boardServices(NodeContext* context);

/// A still LED on a known place: check, measure_place, and known_places/add, undo, clear, fit.
NodePart placeServices(NodeContext* context);

/// Solves one camera against the others, or adds it: recalibrate_camera. Removes one:
/// remove_camera.
NodePart recalibrateServices(NodeContext* context);

/// A rig that corrects itself from ordinary tracking: continuous/apply, continuous/revert.
/// @param one_led_inputs what the health monitor hands on.
NodePart continuousServices(NodeContext* context, InputQueue* one_led_inputs);

/// Reports cameras of the current rig that were moved, and cameras that it lacks: in the status, in
/// /diagnostics, and once in the log. It never changes the rig.
/// @param one_led_inputs gets what the cameras sent: of several LEDs images show one.
NodePart healthMonitor(NodeContext* context, InputQueue* one_led_inputs);

}  // namespace wiimote_tracker
