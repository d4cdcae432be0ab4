// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#pragma once

#include <openssl/ssl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace glint::daemon {

/// TLS on a connected, blocking socket of a client. Thread-compatible.
class ClientTls {
 public:
  /// Shakes hands; the server must show a certificate for `host` that one of `ca_file` (PEM)
  /// vouches for. From here on the process ignores SIGPIPE. @throws std::runtime_error with why
  /// not.
  ClientTls(int socket, const std::string& ca_file, const std::string& host);

  /// Bytes sent, or -1.
  std::ptrdiff_t send(std::string_view bytes);
  /// Bytes received, 0 at the end, or -1; with errno EINTR when it is to be tried again.
  std::ptrdiff_t receive(char* buffer, std::size_t size);
  /// Whether there are bytes that the socket need not be waited for.
  [[nodiscard]] bool has_pending() const { return SSL_pending(ssl_.get()) > 0; }

 private:
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_;
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_;
};

}  // namespace glint::daemon
