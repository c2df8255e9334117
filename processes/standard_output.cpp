// SPDX-License-Identifier: MIT
#include "processes/standard_output.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>

namespace mixloop {
namespace {

int first_failure = 0;

}  // namespace

void open_standard_files() {
  // open() takes the lowest number that is free.
  for (int fd = 0; fd <= 2; ++fd)
    if (fcntl(fd, F_GETFD) < 0 && errno == EBADF) open("/dev/null", O_RDWR);
}

void remember_output_failure(int error) {
  if (first_failure == 0) first_failure = error;
}

void flush_standard_output() {
  if (std::fflush(stdout) != 0) remember_output_failure(errno);
}

int standard_output_failure() {
  flush_standard_output();
  if (std::ferror(stdout) != 0) remember_output_failure(EIO);
  return first_failure;
}

}  // namespace mixloop
