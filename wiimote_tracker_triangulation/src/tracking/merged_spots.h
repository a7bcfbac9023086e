#pragma once

#include "group_state.h"
#include "image_assignment.h"

#include <cstdint>
#include <vector>

// LEDs that are so close in an image that they show one spot.

namespace wiimote_tracker::tracking {

/// Whether an LED without a spot may be merged with another one, which has a spot or has none, too.
/// A tentative track without one may be of the LED itself.
bool mayBeMerged(const ImageAssignment& assignment, const Candidate& candidate);

/// One of two LEDs, each seen by two other cameras, that the candidate's spot may show together;
/// null: there are none.
const Candidate* shownByItsSpot(const ImageAssignment& assignment, const Candidate& candidate);

/// The LED that a candidate is most probably merged with in one spot, of which one of the two has
/// none; null: it is not merged.
const Candidate* mergedWith(const ImageAssignment& assignment, const Candidate& candidate);

/// Updates the track of a candidate that is merged with another one.
void updateMerged(const ImageAssignment& assignment,
                  const Candidate& candidate,
                  const Candidate& other);

/// Assigns an unassigned spot between two confirmed LEDs that have none to the nearer one.
void assignMergedSpots(ImageAssignment* assignment);

/// Follows both hypotheses of merged LEDs from now on.
void openMergedPairs(const ImageAssignment& assignment, std::vector<MergedPair>* pairs);

/// Lets each pair choose the spots of its two LEDs in an image that shows both. Other images update
/// the two as any other track.
void updateMergedPairs(std::vector<MergedPair>* pairs, ImageAssignment* assignment);

/// Removes pairs that are decided, and those whose tracks ended or were reacquired since.
/// @param doubt_time see TrackerOptions [s]
void closeMergedPairs(double time, double doubt_time, GroupState* state);

/// Nothing tells which LED of a merged pair the other track follows, once one of both has ended.
void doubtPartnerOf(std::uint32_t ended, GroupState* state);

}  // namespace wiimote_tracker::tracking
