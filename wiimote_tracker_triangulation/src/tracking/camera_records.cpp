#include "camera_records.h"

#include <algorithm>
#include <bitset>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr unsigned kRecentImages = 0xf;  // mask of the last four

}  // namespace

/// The record of a camera. Adds one if it has none, in place of the oldest if there are too many.
CameraRecords::Record& CameraRecords::of(std::size_t camera) {
  const auto record = std::find_if(records_.begin(), records_.end(),
                                   [&](auto& known) { return known.camera == camera; });
  if (record != records_.end())
    return *record;
  if (records_.size() == kMaximumCameras)
    records_.erase(std::min_element(records_.begin(), records_.end(), [](auto& a, auto& b) {
      return a.last_expected < b.last_expected;
    }));
  Record& added = records_.emplace_back();
  added.camera = camera;
  return added;
}

void CameraRecords::miss(std::size_t camera, double time) {
  Record& record = of(camera);
  record.last_expected = time;
  record.recent = record.recent << 1 & kRecentImages;
}

void CameraRecords::hit(std::size_t camera, double time, double squared_residual, bool is_own) {
  Record& record = of(camera);
  if (!record.recent)
    record.ray = RayOffset();
  record.last_expected = record.last_detected = time;
  if (is_own)
    record.last_detected_alone = time;
  record.squared_residual = squared_residual;
  record.recent = (record.recent << 1 | 1) & kRecentImages;
}

Visibility CameraRecords::visibility(double since) const {
  Visibility result;
  for (const Record& record : records_) {
    const bool is_expected = record.last_expected >= since;
    result.expected += is_expected;
    result.in_view += is_expected || record.last_saturated >= since;
    result.supporting += is_expected && std::bitset<4>(record.recent).count() >= 2;
    if (record.last_detected < since)
      continue;
    if (result.detected < result.rays.size())
      result.rays[result.detected] = &record.ray;
    ++result.detected;
    result.squared_residuals += record.squared_residual;
  }
  return result;
}

double CameraRecords::lastDetectedBy(std::size_t camera) const {
  const auto record = std::find_if(records_.begin(), records_.end(),
                                   [&](auto& known) { return known.camera == camera; });
  return record == records_.end() ? kNever : record->last_detected;
}

bool CameraRecords::wasMissedBy(std::size_t camera) const {
  return std::any_of(records_.begin(), records_.end(), [&](const Record& record) {
    return record.camera == camera && !(record.recent & 1);
  });
}

CameraList CameraRecords::detecting(double since, std::optional<std::size_t> except) const {
  CameraList cameras;
  for (const Record& record : records_) {
    if (record.camera != except && record.last_detected >= since)
      cameras.push_back(record.camera);
  }
  return cameras;
}

std::size_t CameraRecords::showing(double since) const {
  return std::count_if(records_.begin(), records_.end(),
                       [&](const Record& record) { return record.last_detected_alone >= since; });
}

bool CameraRecords::showBeside(const CameraRecords& other, double since) const {
  for (const Record& record : records_) {
    for (const Record& others : other.records_) {
      if (record.camera == others.camera &&
          record.last_detected_alone == others.last_detected_alone &&
          record.last_detected_alone >= since && std::isfinite(record.last_detected_alone))
        return true;
    }
  }
  return false;
}

}  // namespace wiimote_tracker::tracking
