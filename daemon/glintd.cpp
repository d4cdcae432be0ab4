// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
//
// glintd: serves pose and map of a live sensor or a capture.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <iostream>

#include "daemon/config_layers.hpp"
#include "daemon/file_limit.hpp"
#include "daemon/input.hpp"
#include "daemon/log.hpp"
#include "daemon/service.hpp"
#include "daemon/version.hpp"

namespace glint::daemon {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;
constexpr int kBadConfig = 78;  // EX_CONFIG: systemd is told not to start the daemon again.

// Beside clients: sensor, session, maps, metrics.
constexpr std::size_t kOtherFiles = 256;

struct Options {
  std::string config_file;
  bool check_config = false;
  bool print_config = false;
  std::vector<std::string> settings;
  InputOptions input;
};

int serve(const Options& options) {
  const auto read_config = [&options] {
    return read_config_layers(options.config_file, options.settings).config;
  };
  const Config config = read_config();
  if (options.print_config) {
    std::cout << to_toml(config);
    return 0;
  }
  if (!config.sensor.host.empty()) static_cast<void>(sensor_link_options(config.sensor, {}));
  if (options.check_config) {
    std::cout << "glintd: the configuration is good\n";
    return 0;
  }
  set_up_logging(config.log.level);
  spdlog::info("glintd {}", kVersion);
  const std::size_t files = static_cast<std::size_t>(config.server.max_clients) + kOtherFiles;
  if (const std::size_t limit = raise_file_limit(files); limit < files) {
    spdlog::warn(
        "server.max_clients = {}, but only {} files may be open: raise LimitNOFILE or ulimit -n",
        config.server.max_clients, limit);
  }
  // Its end would wait for a name that is being looked up, which takes the resolver half a minute
  // when no server answers: it is left to the process's end.
  static boost::asio::io_context& io = *new boost::asio::io_context(1);
  Service service(io, config, open_input(options.input, config), read_config);
  return service.run();
}

int run(int argc, char** argv) {
  CLI::App app{"glintd: pose and map from an Ouster lidar, over TCP/JSON.", "glintd"};
  Options options;
  app.set_version_flag("--version", std::string("glintd ") + kVersion);
  app.add_option("--config", options.config_file,
                 "Configuration file, with FILE.d/*.toml over it (default: " +
                     std::string(kUsualConfigFile) + ")");
  app.add_flag("--check-config", options.check_config, "Check the configuration and exit");
  app.add_flag("--print-config", options.print_config,
               "Print every key with its value, unit and range, and exit");
  app.add_option("--set", options.settings, "Set one value: key=value; may be given again");
  app.add_option("--source", options.input.source,
                 "udp, pcap:FILE or synth:WORLD[,name=value...] (options of glint simulate)")
      ->capture_default_str();
  app.add_option("--meta", options.input.metadata, "Sensor metadata (JSON)");
  app.add_option("--rate", options.input.rate,
                 "Of a capture or simulation: max or a multiple of its speed")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
    return serve(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  } catch (const ConfigError& error) {
    std::cerr << "glintd: " << error.what() << '\n';
    return kBadConfig;
  } catch (const std::exception& error) {
    std::cerr << "glintd: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace
}  // namespace glint::daemon

// What escapes run() was thrown while it reported something: there is no more to tell than that.
int main(int argc, char** argv) try { return glint::daemon::run(argc, argv); } catch (...) {
  return glint::daemon::kFailed;
}
