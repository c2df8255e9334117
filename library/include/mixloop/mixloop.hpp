// SPDX-License-Identifier: MIT
#pragma once

/// The whole interface; docs/library.md tours it.
#include <mixloop/controller.hpp>
#include <mixloop/plant.hpp>
#include <mixloop/result.hpp>
#include <mixloop/version.hpp>
