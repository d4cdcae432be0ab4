// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>

#include "daemon/config.hpp"

namespace glint::daemon {

/// The server's certificate and key, TLS 1.2 or newer; null when none is configured.
/// @throws ConfigError when only one of them is, or they cannot be used.
std::unique_ptr<boost::asio::ssl::context> make_tls_context(const Config::Server& server);

}  // namespace glint::daemon
