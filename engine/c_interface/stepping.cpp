/// Steps of one cloth and of many in C, and the host's threads.
#include <weft/batch.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/c_interface/handles.h"
#include "engine/c_interface/report.h"
#include "engine/c_interface/structs.h"

namespace weft::c_interface {
namespace {

weft_batch_step default_step() {
  weft_batch_step step{};
  step.size = sizeof step;
  step.result = WEFT_REFUSED;
  step.report = report_of({});
  return step;
}

weft_jobs no_jobs() {
  return {.size = sizeof(weft_jobs), .host = nullptr, .threads = nullptr, .run = nullptr};
}

/// The functions of a host in C, as a JobSystem calls them.
Result<JobSystem> job_system(const weft_jobs* given, weft_jobs& jobs) {
  if (given == nullptr) return JobSystem{};
  const auto read = read_struct("jobs", given, no_jobs());
  if (!read) return Error{read.error()};
  jobs = read.value();
  JobSystem system;
  system.host = &jobs;
  if (jobs.threads != nullptr) {
    system.threads = [](void* host) noexcept {
      const auto& its = *static_cast<const weft_jobs*>(host);
      return its.threads(its.host);
    };
  }
  if (jobs.run != nullptr) {
    system.run = [](void* host, Job job, int times) noexcept {
      const auto& its = *static_cast<const weft_jobs*>(host);
      its.run(its.host, job.function, job.context, times);
    };
  }
  return system;
}

weft_batch_step& step_at(weft_batch_step* steps, std::size_t i) {
  const std::size_t size = steps->size;
  return *reinterpret_cast<weft_batch_step*>(reinterpret_cast<std::byte*>(steps) + i * size);
}

/// Each must have all that results are written to.
Result<void> check_steps(weft_batch_step* steps, std::size_t count) {
  if (auto r = check_struct("steps", steps); !r) return r;
  const std::size_t size = steps->size;
  for (std::size_t i = 0; i < count; ++i) {
    const weft_batch_step& step = step_at(steps, i);
    const auto field = [i](const char* name) { return "steps[" + std::to_string(i) + "]" + name; };
    if (step.size != size || size <= offsetof(weft_batch_step, report)) {
      return Error{field(".size") + ": must be that of the struct, and of the first (" +
                   std::to_string(step.size) + ")"};
    }
    if (auto r = check_size("report", step.report.size); !r) return Error{field(".") + r.error()};
    if (step.report.size > size - offsetof(weft_batch_step, report)) {
      return Error{field(".report.size") + ": goes beyond the step (" +
                   std::to_string(step.report.size) + ")"};
    }
  }
  return {};
}

/// The list of a batch, which the first cloth keeps for later ones.
std::vector<ClothStep>& list_of(weft_batch_step* steps, std::size_t count,
                                std::vector<ClothStep>& without_cloths) {
  for (std::size_t i = 0; i < count; ++i) {
    if (weft_cloth* cloth = step_at(steps, i).cloth; cloth != nullptr) return cloth->batch;
  }
  return without_cloths;
}

void write_result(const ClothStep& done, weft_batch_step& out) {
  std::fill(std::begin(out.message), std::end(out.message), '\0');
  if (done.result) {
    out.result = WEFT_OK;
    write_struct(report_of(done.result.value()), &out.report);
  } else {
    out.result = WEFT_REFUSED;
    done.result.error().copy(out.message, sizeof out.message - 1);
  }
}

}  // namespace
}  // namespace weft::c_interface

using namespace weft::c_interface;

weft_result weft_init_report(weft_report* report, size_t size) {
  return init_struct("report", report_of({}), report, size);
}

weft_result weft_init_jobs(weft_jobs* jobs, size_t size) {
  return init_struct("jobs", no_jobs(), jobs, size);
}

weft_result weft_init_batch_step(weft_batch_step* step, size_t size) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"step", step}}); !r) return r;
    if (auto r = check_size("step", size); !r) return r;
    step->size = size;
    write_struct(default_step(), step);
    if (size > offsetof(weft_batch_step, report)) {
      step->report.size = size - offsetof(weft_batch_step, report);
    }
    return {};
  });
}

weft_result weft_step(weft_cloth* cloth, double dt, const weft_jobs* jobs, weft_report* report) {
  return call([&]() -> weft::Result<void> {
    if (auto r = given({{"cloth", cloth}}); !r) return r;
    if (report != nullptr) {
      if (auto r = check_struct("report", report); !r) return r;
    }
    weft_jobs its{};
    const auto system = job_system(jobs, its);
    if (!system) return weft::Error{system.error()};
    const auto done = cloth->cloth.step(dt, system.value());
    if (!done) return weft::Error{done.error()};
    if (report != nullptr) write_struct(report_of(done.value()), report);
    return {};
  });
}

weft_result weft_step_all(size_t count, weft_batch_step* steps, const weft_jobs* jobs) {
  return call([&]() -> weft::Result<void> {
    if (count == 0) return {};
    if (auto r = check_steps(steps, count); !r) return r;
    weft_jobs its{};
    const auto system = job_system(jobs, its);
    if (!system) return weft::Error{system.error()};
    std::vector<weft::ClothStep> without_cloths;
    std::vector<weft::ClothStep>& batch = list_of(steps, count, without_cloths);
    batch.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const weft_batch_step& step = step_at(steps, i);
      batch[i].cloth = step.cloth == nullptr ? nullptr : &step.cloth->cloth;
      batch[i].dt = step.dt;
    }
    weft::step_all(batch, system.value());
    for (std::size_t i = 0; i < count; ++i) write_result(batch[i], step_at(steps, i));
    return {};
  });
}
