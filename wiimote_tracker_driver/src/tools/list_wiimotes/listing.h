#pragma once

#include "camera_list.h"
#include "remote_check.h"
#include "transport/transport.h"

#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// A remote in the list.
struct Row {
  transport::DeviceName device;  ///< How to open it.
  std::string text;              ///< Its address or virtual:PATH in a cameras.yaml; or empty.
  std::string address;
  std::string description;
  bool can_be_opened = true;
  RemoteCheck check;
  std::vector<std::string> notes;     ///< Sentences for information.
  std::vector<std::string> problems;  ///< Sentences with what to do.
  std::string camera;                 ///< Its name in the cameras.yaml, or empty.
};

/// What list_wiimotes shows.
struct Listing {
  std::vector<Row> remotes;
  std::string advice;                      ///< What to do without remotes; else empty.
  std::vector<CameraList::Camera> absent;  ///< Those whose remotes are not connected.
  std::vector<std::string> camera_problems;
  std::vector<std::string> computer_problems;
};

/// Whether the remote is free or in use by a driver.
bool isUsable(const Row& row);

/// The name of the remote in the list, which may have its address, path or socket; or empty.
std::string cameraOf(const Row& row, const CameraList& list);

/// The cameras of the list that are none of these remotes.
std::vector<CameraList::Camera> absentOf(const CameraList& list, const std::vector<Row>& rows);

/// Prints a remote under its number, for people.
void print(int number, const Row& row);

/// Prints all but the remotes, for people.
void printRest(const Listing& listing);

/// For programs: one JSON object.
std::string json(const Listing& listing);

}  // namespace wiimote_tracker::list_wiimotes
