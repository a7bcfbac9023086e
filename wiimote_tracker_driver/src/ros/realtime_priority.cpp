#include "realtime_priority.h"

#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <cstring>

namespace wiimote_tracker::driver {

std::string takeRealtimePriority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0)
    return "";
  const std::string wanted = std::to_string(priority);
  if (error == EPERM)
    return "no permission for real-time priority " + wanted +
           ", so reports are read late when the computer is busy: put the line \"@input - "
           "rtprio " +
           wanted +
           "\" into /etc/security/limits.conf and log in again as a member of the group input, or "
           "set ~realtime_priority to 0";
  return "real-time priority " + wanted + " is refused (" + std::strerror(error) +
         "): set ~realtime_priority to 0";
}

}  // namespace wiimote_tracker::driver
