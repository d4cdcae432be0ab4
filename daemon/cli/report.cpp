// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/cli/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "daemon/base64.hpp"
#include "daemon/cli/svg_plot.hpp"
#include "daemon/cli/text_file.hpp"
#include "daemon/png.hpp"

namespace glint::cli {
namespace {

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark}
body{font:15px/1.5 system-ui,sans-serif;max-width:1180px;margin:2rem auto;padding:0 1rem}
h1{font-size:1.4rem}h2{font-size:1.05rem;margin:2rem 0 .5rem}
.row{display:flex;flex-wrap:wrap;gap:1.5rem}.row>figure{flex:1 1 480px;margin:0}
figcaption{font-size:.85rem;opacity:.75}
svg{width:100%;height:auto;background:#fff;border:1px solid #8884}
svg text{font:12px system-ui,sans-serif;fill:#333}svg text.legend{font-weight:600}
svg .grid{stroke:#ddd}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
td,th{padding:.15rem .8rem;text-align:right;border-bottom:1px solid #8884}
td:first-child,th:first-child{text-align:left}
img{width:100%;image-rendering:pixelated;min-height:90px;object-fit:fill;border:1px solid #8884}
)";

std::string figure(const std::string& body, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", body,
                     html_escaped(caption));
}

double seconds_from_start(const ReplayResult& result, const slam::OdometryEstimate& estimate) {
  return static_cast<double>(estimate.stamp - result.estimates.front().stamp) * kSecondsPerNs;
}

std::string trajectory_section(const ReplayResult& result) {
  Curve above;
  Curve height;
  for (const slam::OdometryEstimate& estimate : result.estimates) {
    if (!has_pose(estimate)) continue;
    const Pose pose = map_pose(result, estimate);
    above.points.emplace_back(pose.translation_m.x(), pose.translation_m.y());
    height.points.emplace_back(seconds_from_start(result, estimate), pose.translation_m.z());
  }
  return "<h2>Trajectory</h2><div class=row>" +
         figure(svg_plot(
                    {above},
                    {.x_label = "x, m", .y_label = "y, m", .equal_scale = true, .height_px = 420}),
                "From above, map frame.") +
         figure(svg_plot({height}, {.x_label = "time, s", .y_label = "z, m", .height_px = 420}),
                "Height over time, map frame.") +
         "</div>";
}

// 3 tracking, 2 degraded, 1 initialising, 0 lost: higher is better.
double state_level(slam::TrackingState state) {
  switch (state) {
    case slam::TrackingState::kTracking:
      return 3;
    case slam::TrackingState::kDegraded:
      return 2;
    case slam::TrackingState::kInit:
      return 1;
    default:
      return 0;
  }
}

std::string health_section(const ReplayResult& result) {
  Curve keypoints{"keypoints", {}};
  Curve matches{"matches", {}};
  Curve inliers{"inliers", {}};
  Curve state{"state", {}};
  Curve completeness{"completeness", {}};
  for (const slam::OdometryEstimate& estimate : result.estimates) {
    const double t_s = seconds_from_start(result, estimate);
    keypoints.points.emplace_back(t_s, estimate.keypoints);
    matches.points.emplace_back(t_s, estimate.matches);
    inliers.points.emplace_back(t_s, estimate.inliers);
    state.points.emplace_back(t_s, state_level(estimate.state));
    completeness.points.emplace_back(t_s, estimate.completeness);
  }
  return "<h2>Health</h2><div class=row>" +
         figure(svg_plot({keypoints, matches, inliers}, {.x_label = "time, s", .y_label = "count"}),
                "Keypoints, matches and inliers of each scan.") +
         figure(svg_plot({state, completeness}, {.x_label = "time, s", .y_label = "level"}),
                "State (3 TRACKING, 2 DEGRADED, 1 INIT, 0 LOST) and share of columns received.") +
         "</div>";
}

std::string stage_section(const ReplayResult& result) {
  std::string rows;
  for (std::size_t i = 0; i < slam::kStageCount; ++i) {
    const StageSummary s = result.stages.wall(static_cast<slam::Stage>(i));
    if (s.max == 0.0) continue;
    rows += fmt::format(
        "<tr><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td>"
        "<td>{:.2f}</td><td>{:.2f}</td></tr>",
        slam::kStageNames[i], s.mean, s.std, s.p50, s.p95, s.p99, s.max);
  }
  return "<h2>Time per scan, ms</h2><table><tr><th>stage</th><th>mean</th><th>σ</th><th>p50</th>"
         "<th>p95</th><th>p99</th><th>max</th></tr>" +
         rows + "</table>";
}

std::string paper_section(const ReplayResult& result) {
  std::string rows;
  for (const auto& [name, ms] : result.stages.paper_table()) {
    rows += fmt::format("<tr><td>{}</td><td>{:.2f} ± {:.2f}</td></tr>", name, ms.mean, ms.std);
  }
  return "<h2>As the paper counts, ms</h2><table><tr><th>step</th><th>mean ± σ</th></tr>" + rows +
         "</table>";
}

std::string misfit_text(const std::optional<slam::LoopMisfit>& misfit) {
  if (!misfit) return "";
  return fmt::format("{:.3f} m, {:.2f}°", misfit->distance_m, misfit->angle_rad * 180.0 / M_PI);
}

std::string loop_row(const slam::LoopReport& report) {
  const slam::LoopCandidate& c = report.candidate;
  return fmt::format(
      "<tr><td>{} - {}</td><td>{}</td><td>{:.2f}</td><td>{}</td><td>{}</td><td>{:.2f}</td>"
      "<td>{:.3f}</td><td>{}</td><td>{}</td><td>{:.3f}</td></tr>",
      c.from, c.to, c.accepted ? "accepted" : html_escaped(c.reason), c.similarity, c.matches,
      c.inliers, c.overlap, c.rms_m, misfit_text(report.before), misfit_text(report.after),
      report.correction.distance_m);
}

// Accepted ones first; of the others no more than a page holds.
std::string loop_section(const ReplayResult& result) {
  constexpr std::size_t kMostRows = 1000;
  std::vector<const slam::LoopReport*> reports;
  for (const slam::LoopReport& report : result.loops) reports.push_back(&report);
  std::stable_partition(reports.begin(), reports.end(),
                        [](const auto* report) { return report->candidate.accepted; });
  std::string rows;
  for (std::size_t i = 0; i < std::min(reports.size(), kMostRows); ++i)
    rows += loop_row(*reports[i]);
  std::string html = fmt::format("<h2>Loops: {} accepted, {} refused</h2>", result.loops_accepted,
                                 result.loops_rejected);
  if (rows.empty()) return html;
  if (reports.size() > kMostRows) {
    html += fmt::format("<p>{} more are in the session file.</p>", reports.size() - kMostRows);
  }
  return html +
         "<table><tr><th>keyframes</th><th>verdict</th><th>similarity</th><th>matches</th>"
         "<th>inliers</th><th>overlap</th><th>rms, m</th><th>off before</th><th>off after</th>"
         "<th>moved at most, m</th></tr>" +
         rows + "</table>";
}

std::string image_section(const ReplayResult& result) {
  if (result.sample_images.empty()) return {};
  std::string html = "<h2>Intensity images</h2>";
  for (const slam::ScanImages& images : result.sample_images) {
    const std::vector<std::byte> png = encode_png(images.intensity_u8);
    html += fmt::format("<p><img alt=\"intensity image\" src=\"data:image/png;base64,{}\"></p>\n",
                        daemon::base64_encode(png));
  }
  return html;
}

std::string summary_section(const nlohmann::ordered_json& summary) {
  std::string rows;
  for (const auto& [key, value] : summary.items()) {
    if (value.is_object() || value.is_array()) continue;
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>", html_escaped(key), html_escaped(text));
  }
  return "<h2>Summary</h2><table>" + rows + "</table>";
}

}  // namespace

void write_report(const std::filesystem::path& file, const std::string& title,
                  const nlohmann::ordered_json& summary, const ReplayResult& result) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=en><meta charset=utf-8>\n<meta name=viewport "
      "content=\"width=device-width\">\n<title>Glint: {0}</title>\n<style>{1}</style>\n"
      "<h1>Glint replay of {0}</h1>\n",
      html_escaped(title), kStyle);
  if (result.estimates.empty()) {
    html += "<p>The capture held no scan.</p>";
  } else {
    html += trajectory_section(result) + loop_section(result) + health_section(result) +
            paper_section(result) + stage_section(result) + image_section(result);
  }
  html += summary_section(summary) + "</html>\n";
  write_text_file(file, html);
}

}  // namespace glint::cli
