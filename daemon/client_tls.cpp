// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/client_tls.hpp"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <stdexcept>

namespace glint::daemon {
namespace {

int whole_size(std::size_t size) { return static_cast<int>(std::min<std::size_t>(size, INT_MAX)); }

/// What the last failure was, for people.
std::string tls_failure(const SSL* ssl) {
  if (const long verdict = SSL_get_verify_result(ssl); verdict != X509_V_OK) {
    return fmt::format("its certificate is not trusted: {}",
                       X509_verify_cert_error_string(verdict));
  }
  const char* reason = ERR_reason_error_string(ERR_peek_last_error());
  return reason == nullptr ? "it hung up; does it speak TLS?" : reason;
}

}  // namespace

ClientTls::ClientTls(int socket, const std::string& ca_file, const std::string& host)
    : context_(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free), ssl_(nullptr, &SSL_free) {
  std::signal(SIGPIPE, SIG_IGN);
  ERR_clear_error();
  SSL_CTX_set_min_proto_version(context_.get(), TLS1_2_VERSION);
  if (SSL_CTX_load_verify_file(context_.get(), ca_file.c_str()) != 1) {
    throw std::runtime_error(fmt::format("{} holds no certificate in PEM", ca_file));
  }
  SSL_CTX_set_verify(context_.get(), SSL_VERIFY_PEER, nullptr);
  ssl_.reset(SSL_new(context_.get()));
  // What is not for the reader must not make it wait for more.
  SSL_clear_mode(ssl_.get(), SSL_MODE_AUTO_RETRY);
  if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl_.get()), host.c_str()) != 1) {
    SSL_set1_host(ssl_.get(), host.c_str());
    SSL_ctrl(ssl_.get(), SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
             const_cast<char*>(host.c_str()));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  }
  SSL_set_fd(ssl_.get(), socket);
  ERR_clear_error();
  if (SSL_connect(ssl_.get()) != 1) throw std::runtime_error(tls_failure(ssl_.get()));
}

std::ptrdiff_t ClientTls::send(std::string_view bytes) {
  const int sent = SSL_write(ssl_.get(), bytes.data(), whole_size(bytes.size()));
  return sent > 0 ? sent : -1;
}

std::ptrdiff_t ClientTls::receive(char* buffer, std::size_t size) {
  ERR_clear_error();
  const int got = SSL_read(ssl_.get(), buffer, whole_size(size));
  if (got > 0) return got;
  const int why = SSL_get_error(ssl_.get(), got);
  if (why == SSL_ERROR_WANT_READ) errno = EINTR;
  if (why == SSL_ERROR_WANT_READ) return -1;
  return 0;
}

}  // namespace glint::daemon
