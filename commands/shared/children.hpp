// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace mixloop {

/// A process that this one started: in a process group of its own, killed by the kernel when this one dies,
/// its stderr read through a pipe.
class Child {
 public:
  /// Throws RunFault("cannot_start"). `inherited`: a descriptor that the child keeps, or -1.
  Child(std::string name, const std::vector<std::string>& command, int inherited = -1);
  ~Child();
  Child(Child&&) noexcept;
  Child& operator=(Child&&) = delete;

  const std::string& name() const { return name_; }
  int pidfd() const { return pidfd_; }    ///< readable when it has ended
  int errors() const { return errors_; }  ///< the read end of its stderr; -1 once closed
  bool running() const { return pid_ > 0; }

  /// Reads what is there of its stderr; calls `line` for each whole line.
  void read_errors(const std::function<void(const std::string&)>& line);
  /// The last lines it wrote on stderr.
  std::string last_words() const;

  void signal(int number) const;
  /// Collects its end; true when it has ended. Then exit_status() or died_of() hold.
  bool reap(bool wait = false);
  int exit_status() const { return exit_status_; }  ///< -1 where a signal killed it
  int killed_by() const { return killed_by_; }      ///< 0 where none did

 private:
  std::string name_;
  pid_t pid_ = -1;
  int pidfd_ = -1;
  int errors_ = -1;
  std::string partial_;
  std::vector<std::string> last_lines_;
  int exit_status_ = -1;
  int killed_by_ = 0;
};

}  // namespace mixloop
