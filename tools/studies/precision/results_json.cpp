#include "tools/studies/precision/results_json.h"

#include <nlohmann/json.hpp>

namespace weft::tools::precision {
namespace {

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

void add_outcome(Json& json, const Outcome& outcome) {
  json["ms_per_frame"] = outcome.ms_per_frame;
  json["max_strain"] = outcome.max_strain;
  json["trajectory_error"] = optional_json(outcome.trajectory_error);
  json["mean_max_strain"] = outcome.mean_max_strain;
  json["energy_gain"] = outcome.energy_gain;
  json["status"] = outcome.status;
  json["frames"] = outcome.frames;
  json["counts"] = outcome.counts();
}

/// Those that were asked for; where they are automatic, what it came to.
Json substeps(int asked, const Outcome& outcome) {
  return asked == kAutomaticSubsteps ? Json(outcome.substeps) : Json(asked);
}

Json point_json(const Task& task, const Point& point) {
  Json json{{"scene", task.scene},
            {"size", task.size},
            {"contender", contender(point)},
            {"solver", point.solver},
            {"scheme", point.scheme},
            {"backend", point.backend},
            {"substeps", substeps(point.knobs.substeps, point.outcome)},
            {"tolerance", optional_json(point.knobs.tolerance)},
            {"iterations", point.knobs.iterations}};
  add_outcome(json, point.outcome);
  return json;
}

Json points_json(const Study& study, bool peers) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    for (const Point& point : chart.points) {
      if (is_peer(point) == peers) json.push_back(point_json(chart.task, point));
    }
  }
  return json;
}

Json scenes_json(const Study& study) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    json.push_back({{"scene", chart.task.scene},
                    {"size", chart.task.size},
                    {"particles", chart.task.description.positions.size()},
                    {"frames", chart.task.frames},
                    {"seconds_limit", chart.seconds_limit},
                    {"threads", chart.task.threads},
                    {"reference_by", chart.task.reference_by},
                    {"reference_error", chart.task.reference_error}});
  }
  return json;
}

Json cheapest_json(const Study& study) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    for (const double bound : kBounds) {
      for (const std::string& name : contenders(chart)) {
        const Point* point = cheapest(chart, name, bound);
        if (!point) continue;
        Json row = point_json(chart.task, *point);
        row["bound"] = bound;
        json.push_back(std::move(row));
      }
    }
  }
  return json;
}

Json motion_json(const Study& study) {
  Json json = Json::array();
  for (const Chart& chart : study.charts) {
    for (const MotionPoint& point : chart.motion) {
      json.push_back({{"scene", chart.task.scene},
                      {"size", chart.task.size},
                      {"asked", point.asked},
                      {"got", point.got},
                      {"estimated", point.estimated},
                      {"substeps", point.substeps},
                      {"ms_per_frame", point.ms_per_frame}});
    }
  }
  return json;
}

Json sizes_json(const SizeStudy& study) {
  Json json{{"scene", study.scene},
            {"tolerance", study.tolerance},
            {"frames", study.frames},
            {"threads", study.threads},
            {"curves", Json::array()}};
  for (const SizeCurve& curve : study.curves) {
    Json points = Json::array();
    for (const SizePoint& point : curve.points) {
      Json& row = points.emplace_back(
          Json{{"size", point.size}, {"substeps", substeps(point.substeps, point.outcome)}});
      add_outcome(row, point.outcome);
      row.erase("trajectory_error");
    }
    json["curves"].push_back({{"solver", curve.solver},
                              {"exponent", optional_json(curve.exponent)},
                              {"end", curve.end},
                              {"points", std::move(points)}});
  }
  return json;
}

}  // namespace

Json to_json(const Study& study) {
  Json json{{"points", points_json(study, false)}, {"order", Json::object()}};
  // Of the first scene; each has a key, measured or not.
  for (const char* scheme : {"paper", "rattle", "implicit", "bdf2"})
    json["order"][scheme] = nullptr;
  json["orders"] = json["order_points"] = Json::array();
  for (const Order& order : study.orders) {
    const Json exponent = optional_json(order.order);
    if (order.scene == study.orders.front().scene) json["order"][order.scheme] = exponent;
    json["orders"].push_back(
        {{"scene", order.scene}, {"scheme", order.scheme}, {"order", exponent}});
    for (const OrderPoint& point : order.points) {
      json["order_points"].push_back({{"scene", order.scene},
                                      {"scheme", order.scheme},
                                      {"dt", point.dt},
                                      {"trajectory_error", point.error}});
    }
  }
  json["peers"] = points_json(study, true);
  json["bullet"] = study.bullet.empty() ? "not built in" : study.bullet;
  json["scenes"] = scenes_json(study);
  json["cheapest"] = cheapest_json(study);
  json["motion"] = motion_json(study);
  if (study.sizes) json["sizes"] = sizes_json(*study.sizes);
  json["quick"] = study.quick;
  return json;
}

}  // namespace weft::tools::precision
