// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// The protocol over TLS, with a certificate made for the test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "daemon/client.hpp"
#include "daemon/test_daemon.hpp"

namespace glint::daemon {
namespace {

using test::TestDaemon;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr long kCertificateSeconds = 3600;

/// A key, and a certificate that it signs itself, for 127.0.0.1.
class TlsTest : public testing::Test {
 protected:
  TlsTest()
      : directory_(std::filesystem::path(testing::TempDir()) /
                   ("tls_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
    write_pair("server");
    config_.server.tls_certificate_file = file("server.crt");
    config_.server.tls_key_file = file("server.key");
  }
  ~TlsTest() override { std::filesystem::remove_all(directory_); }
  [[nodiscard]] std::string file(const std::string& name) const { return directory_ / name; }

  void write_pair(const std::string& name) {
    EVP_PKEY* key = EVP_EC_gen("P-256");
    X509* certificate = X509_new();
    X509_set_version(certificate, 2);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate), 0);
    X509_gmtime_adj(X509_getm_notAfter(certificate), kCertificateSeconds);
    X509_set_pubkey(certificate, key);
    const std::string common_name = "glint " + name;
    X509_NAME* subject = X509_get_subject_name(certificate);
    X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(common_name.c_str()), -1, -1,
                               0);
    X509_set_issuer_name(certificate, subject);
    X509_EXTENSION* names =
        X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "IP:127.0.0.1");
    X509_add_ext(certificate, names, -1);
    X509_sign(certificate, key, EVP_sha256());
    std::FILE* out = std::fopen(file(name + ".crt").c_str(), "w");
    PEM_write_X509(out, certificate);
    static_cast<void>(std::fclose(out));
    out = std::fopen(file(name + ".key").c_str(), "w");
    PEM_write_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, nullptr);
    static_cast<void>(std::fclose(out));
    X509_EXTENSION_free(names);
    X509_free(certificate);
    EVP_PKEY_free(key);
  }
  static std::string connect_error(const std::string& target, const ClientSecurity& security) {
    try {
      const Client client(target, security);
    } catch (const ClientError& error) {
      return error.what();
    }
    return "";
  }

  const std::filesystem::path directory_;
  Config config_;
};

TEST_F(TlsTest, TheProtocolIsServedOverTls) {
  TestDaemon daemon(config_);
  Client client(daemon.address(), {file("server.crt"), ""});
  EXPECT_EQ(client.call("get_pose")["state"], "INIT");
  // Many records: a long answer, and more than one waiting.
  client.send_raw("{\"id\":1,\"method\":\"get_config\"}\n{\"id\":2,\"method\":\"get_metrics\"}\n");
  EXPECT_EQ(client.next_message(5s)["id"], 1);
  EXPECT_EQ(client.next_message(5s)["id"], 2);
}

TEST_F(TlsTest, TokensAreAskedForAndSentWithin) {
  std::ofstream(file("token")) << "0123456789abcdef\n";
  config_.server.read_token_file = file("token");
  config_.server.require_token = true;
  TestDaemon daemon(config_);
  Client client(daemon.address(), {file("server.crt"), "0123456789abcdef"});
  EXPECT_EQ(client.call("get_pose")["state"], "INIT");
  EXPECT_THAT(connect_error(daemon.address(), {file("server.crt"), "0123456789abcdeX"}),
              HasSubstr("refuses the token"));
}

TEST_F(TlsTest, ARenewedCertificateIsServedAndConnectionsGoOn) {
  TestDaemon daemon(config_);
  Client before(daemon.address(), {file("server.crt"), ""});
  std::filesystem::copy(file("server.crt"), file("former.crt"));
  write_pair("server");
  daemon.read_secrets_again(config_);
  EXPECT_EQ(before.call("get_pose")["state"], "INIT");
  Client after(daemon.address(), {file("server.crt"), ""});
  EXPECT_EQ(after.call("get_pose")["state"], "INIT");
  EXPECT_THAT(connect_error(daemon.address(), {file("former.crt"), ""}), HasSubstr("not trusted"));
}

TEST_F(TlsTest, ARenewedKeyThatDoesNotFitChangesNothing) {
  TestDaemon daemon(config_);
  std::filesystem::copy(file("server.crt"), file("former.crt"));
  std::ofstream(file("server.key")) << "half of it\n";
  EXPECT_THROW(daemon.read_secrets_again(config_), ConfigError);
  Client client(daemon.address(), {file("former.crt"), ""});
  EXPECT_EQ(client.call("get_pose")["state"], "INIT");
}

TEST_F(TlsTest, ATokenThatIsWithdrawnLetsNobodyInAnyMore) {
  std::ofstream(file("token")) << "0123456789abcdef\nfedcba9876543210\n";
  config_.server.read_token_file = file("token");
  config_.server.require_token = true;
  TestDaemon daemon(config_);
  const ClientSecurity withdrawn{file("server.crt"), "0123456789abcdef"};
  const ClientSecurity kept{file("server.crt"), "fedcba9876543210"};
  Client client(daemon.address(), withdrawn);
  daemon.read_secrets_again(config_);
  EXPECT_EQ(client.call("get_pose")["state"], "INIT") << "nothing has changed";
  std::ofstream(file("token")) << "fedcba9876543210\n";
  daemon.read_secrets_again(config_);
  EXPECT_THROW(client.call("get_pose"), ClientError);
  EXPECT_THAT(connect_error(daemon.address(), withdrawn), HasSubstr("refuses the token"));
  Client other(daemon.address(), kept);
  EXPECT_EQ(other.call("get_pose")["state"], "INIT");
}

TEST_F(TlsTest, ACertificateThatNobodyVouchesForIsRefusedByTheClient) {
  TestDaemon daemon(config_);
  write_pair("other");
  EXPECT_THAT(connect_error(daemon.address(), {file("other.crt"), ""}), HasSubstr("not trusted"));
  const std::string by_name = "localhost" + daemon.address().substr(daemon.address().find(':'));
  EXPECT_THAT(connect_error(by_name, {file("server.crt"), ""}), HasSubstr("not trusted"))
      << "it is for 127.0.0.1";
}

TEST_F(TlsTest, AHandshakeThatDoesNotComeIsCut) {
  TestDaemon daemon(config_);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(connect_error(daemon.address(), {}), HasSubstr("--tls-ca"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 8s);
  Client client(daemon.address(), {file("server.crt"), ""});
  EXPECT_EQ(client.call("get_status")["server"]["failed_handshakes"], 1);
}

TEST_F(TlsTest, CertificatesThatCannotBeUsedAreConfigErrors) {
  const auto error_of = [](const Config& config) -> std::string {
    try {
      static_cast<void>(make_tls_context(config.server));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  Config config = config_;
  config.server.tls_key_file = "";
  EXPECT_THAT(error_of(config), HasSubstr("belong together"));
  config.server.tls_key_file = file("none.key");
  EXPECT_THAT(error_of(config), HasSubstr("server.tls_key_file"));
  write_pair("other");
  config.server.tls_key_file = file("other.key");
  EXPECT_THAT(error_of(config), HasSubstr("server.tls_key_file"));
  config.server.tls_certificate_file = file("server.key");
  EXPECT_THAT(error_of(config), HasSubstr("server.tls_certificate_file"));
}

}  // namespace
}  // namespace glint::daemon
