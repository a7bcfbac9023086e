// Users of a device: found for real processes, on a plain file in place of a hidraw node.
#include "contains.h"
#include "transport/transport.h"
#include "transport/users.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>

namespace wiimote_tracker::transport {
namespace {

/// Another program that has the file open, and locked if requested, while this object lives.
class OtherProgram {
 public:
  OtherProgram(const std::string& path, bool lock) {
    std::array<int, 2> started{};
    std::array<int, 2> alive{};
    EXPECT_EQ(0, ::pipe2(started.data(), O_CLOEXEC));
    EXPECT_EQ(0, ::pipe2(alive.data(), O_CLOEXEC));
    process_ = ::fork();
    if (process_ == 0) {
      const int fd = ::open(path.c_str(), O_RDWR);
      if (fd < 0 || (lock && ::flock(fd, LOCK_EX | LOCK_NB) != 0))
        ::_exit(1);
      ::dup2(alive[0], STDIN_FILENO);
      ::dup2(started[1], STDOUT_FILENO);
      ::setenv("ROS_NAMESPACE", "/wiimote_1", 1);
      // Reports that it runs, and waits for its input to end.
      ::execl("/bin/sh", "/bin/sh", "-c", "echo; read end", "driver", "__name:=driver", nullptr);
      ::_exit(1);
    }
    ::close(started[1]);
    ::close(alive[0]);
    char byte = 0;
    EXPECT_EQ(1, ::read(started[0], &byte, 1));
    ::close(started[0]);
    alive_ = alive[1];
  }
  ~OtherProgram() {
    ::close(alive_);
    ::waitpid(process_, nullptr, 0);
  }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;

  pid_t process() const { return process_; }

 private:
  pid_t process_ = 0;
  int alive_ = -1;
};

class Users : public testing::Test {
 protected:
  void SetUp() override {
    // A file system like that of the device nodes.
    char pattern[] = "/dev/shm/wiimote_tracker_users_XXXXXX";
    const int fd = ::mkostemp(pattern, O_CLOEXEC);
    ASSERT_LE(0, fd);
    ::close(fd);
    path_ = pattern;
  }
  void TearDown() override { ::unlink(path_.c_str()); }

  int open() const { return ::open(path_.c_str(), O_RDWR | O_CLOEXEC); }

  static std::string refusal(int fd) {
    try {
      lockDevice(fd, "the Wii Remote X");
    } catch (const DeviceTaken& e) {
      return e.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
  }

  std::string path_;
};

TEST_F(Users, LockIsFreeAgainWhenItsFileIsClosed) {
  const int first = open();
  const int second = open();
  EXPECT_FALSE(lockHolder(first));
  lockDevice(first, "");
  EXPECT_EQ(::getpid(), lockHolder(second));
  EXPECT_THROW(lockDevice(second, ""), DeviceTaken);
  ::close(first);
  lockDevice(second, "");
  ::close(second);
}

TEST_F(Users, SecondDriverOfThisProcess) {
  const int first = open();
  const int second = open();
  lockDevice(first, "");
  const std::string sentence = refusal(second);
  EXPECT_TRUE(contains(sentence, "the Wii Remote X is in use by this very process (")) << sentence;
  EXPECT_TRUE(contains(sentence, "process " + std::to_string(::getpid()) + ")")) << sentence;
  ::close(first);
  ::close(second);
}

TEST_F(Users, DriverInAnotherProcessWithItsNodeName) {
  const OtherProgram other(path_, true);
  const int fd = open();
  EXPECT_EQ(other.process(), lockHolder(fd));
  EXPECT_EQ("the Wii Remote X is in use by sh (ROS node /wiimote_1/driver, process " +
                std::to_string(other.process()) + "): stop that one or choose another device",
            refusal(fd));
  ::close(fd);
}

TEST_F(Users, ProgramsWithoutTheLockAreFound) {
  EXPECT_EQ("", sharedWith(path_));
  const int fd = open();
  lockDevice(fd, "");
  EXPECT_EQ("", sharedWith(path_)) << "this process is not listed";
  {
    const OtherProgram other(path_, false);
    const std::string sentence = sharedWith(path_);
    EXPECT_TRUE(contains(sentence, path_ + " is open in sh (")) << sentence;
    EXPECT_TRUE(contains(sentence, std::to_string(other.process()))) << sentence;
  }
  EXPECT_EQ("", sharedWith(path_));
  EXPECT_EQ("", sharedWith(path_ + "_that_is_not_there"));
  ::close(fd);
}

TEST_F(Users, AProcessThatHasEndedIsNamedByItsNumber) {
  pid_t gone = 0;
  { gone = OtherProgram(path_, false).process(); }
  EXPECT_EQ("another program (process " + std::to_string(gone) + ")", describeProcess(gone));
}

}  // namespace
}  // namespace wiimote_tracker::transport
