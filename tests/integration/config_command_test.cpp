// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/glint_command.hpp"

namespace glint::test {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;

TEST(ConfigCommandTest, EveryValueIsPrintedWithWhereItComesFrom) {
  const fs::path directory =
      fs::path(testing::TempDir()) / ("config_command_test_" + std::to_string(getpid()));
  const fs::path file = directory / "glint.toml";
  const fs::path drop_in = directory / "glint.toml.d" / "site.toml";
  fs::create_directories(drop_in.parent_path());
  std::ofstream(file) << "[slam]\npreset = \"paper\"\n";
  std::ofstream(drop_in) << "[server]\nmax_clients = 5\n";
  const std::vector<std::string> arguments = {"config", "--config", file.string(), "--set",
                                              "log.level=warn"};
  const CommandResult text = run_glint(arguments);
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, ContainsRegex("\nmax_clients = 5 +# " + drop_in.string() + ":2\n"));
  EXPECT_THAT(text.out, ContainsRegex("\ndeskew = false +# preset paper\n"));
  EXPECT_THAT(text.out, ContainsRegex("\nlevel = \"warn\" +# --set\n"));
  EXPECT_THAT(text.out, ContainsRegex("\nsearch_s = 60.0 +# default\n"));

  auto with_json = arguments;
  with_json.emplace_back("--json");
  const auto json = nlohmann::json::parse(run_glint(with_json).out);
  EXPECT_EQ(json["files"], (nlohmann::json{file.string(), drop_in.string()}));
  EXPECT_EQ(json["config"]["slam"]["preset"],
            (nlohmann::json{{"value", "paper"}, {"from", file.string() + ":2"}}));

  std::ofstream(drop_in) << "[server]\nmax_clients = 50000\n";
  const CommandResult bad = run_glint(arguments);
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.out, HasSubstr(drop_in.string() + ":2"));
  fs::remove_all(directory);
}

}  // namespace
}  // namespace glint::test
