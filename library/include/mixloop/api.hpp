// SPDX-License-Identifier: MIT
#pragma once

/// What libmixloop exports: the names of docs/library.md and no others.
#define MIXLOOP_API __attribute__((visibility("default")))

namespace mixloop {
/// The version of the binary interface that these names belong to; a program writes mixloop::Scene. (The
/// library's own sources, whose rooms have names of their own, write v1::Scene.)
#ifndef MIXLOOP_LIBRARY_SOURCE
inline
#endif
    namespace v1 {
/// How the library's own sources reach what its types are made of.
struct Inside;
}  // namespace v1
}  // namespace mixloop
