// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/tls_context.hpp"

#include <fmt/format.h>

#include "daemon/access.hpp"

namespace glint::daemon {

std::unique_ptr<boost::asio::ssl::context> make_tls_context(const Config::Server& server) {
  namespace ssl = boost::asio::ssl;
  if (server.tls_certificate_file.empty() != server.tls_key_file.empty()) {
    throw ConfigError(
        "server.tls_certificate_file and server.tls_key_file belong together: set both, or none");
  }
  if (server.tls_certificate_file.empty()) return nullptr;
  auto context = std::make_unique<ssl::context>(ssl::context::tls_server);
  context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                       ssl::context::no_tlsv1_1 | SSL_OP_NO_RENEGOTIATION);
  boost::system::error_code error;
  const std::string certificate =
      secret_path(server.tls_certificate_file, "server.tls_certificate_file");
  context->use_certificate_chain_file(certificate, error);
  if (error) {
    throw ConfigError(fmt::format("server.tls_certificate_file: {} holds no certificate in PEM: {}",
                                  certificate, error.message()));
  }
  const std::string key = secret_path(server.tls_key_file, "server.tls_key_file");
  // With a passphrase nobody could start the daemon unattended, and OpenSSL would ask a terminal.
  context->set_password_callback([](std::size_t, auto) { return std::string(); });
  context->use_private_key_file(key, ssl::context::pem, error);
  if (error) {
    throw ConfigError(fmt::format(
        "server.tls_key_file: {} holds no key in PEM, without a passphrase, of the certificate in "
        "server.tls_certificate_file: {}",
        key, error.message()));
  }
  return context;
}

}  // namespace glint::daemon
