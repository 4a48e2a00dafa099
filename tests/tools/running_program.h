/// The program at work beside a test.
#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/tools/temporary_folder.h"

extern char** environ;

namespace weft::tools {

/// The program at work in a process of its own.
class Running {
 public:
  Running(const TemporaryFolder& folder, std::vector<std::string> arguments) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string out = folder.file("stdout"), err = folder.file("stderr");
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    std::string program = WEFT_PROGRAM;
    std::vector<char*> pointers{program.data()};
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawnattr_t attributes;  // a hangup may be ignored here (nohup), and would be there
    posix_spawnattr_init(&attributes);
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(&usual, SIGHUP);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int failure =
        posix_spawn(&process_, WEFT_PROGRAM, &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    REQUIRE(failure == 0);
  }
  void interrupt() const { send(SIGINT); }
  void send(int signal) const { kill(process_, signal); }
  void kill_at_once() const {
    send(SIGKILL);
    int status = 0;
    waitpid(process_, &status, 0);
    REQUIRE(WIFSIGNALED(status));
  }
  int exit_code() const {
    int status = 0;
    waitpid(process_, &status, 0);
    REQUIRE(WIFEXITED(status));
    return WEXITSTATUS(status);
  }

 private:
  pid_t process_ = 0;
};

inline void wait_for(const std::function<bool()>& sight) {
  while (!sight()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

}  // namespace weft::tools
