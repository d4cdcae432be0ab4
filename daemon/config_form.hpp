// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <string_view>

#include "daemon/config.hpp"

namespace glint::daemon {

/// What a value must look like where its type, range and choices do not tell, in words such as "an
/// IP address, or empty"; empty for keys that have no such form. A network that does not have the
/// address now, a name that does not resolve now: those are no faults of the form.
std::string_view config_form(std::string_view key);

/// Whether `value` has the form of `key`.
bool has_config_form(std::string_view key, const Json& value);

}  // namespace glint::daemon
