#include "tests/support/orderings.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace weft::test {
namespace {

class Check {
 public:
  Check(const Ordering& ordering, std::span<const Link> links, std::size_t particles)
      : o_(ordering), links_(links), particles_(particles) {
    slots();
    constraints();
    tiles();
    batches();
    colours();
    share();
  }
  std::string fault() const { return fault_; }

 private:
  bool expect(bool holds, const std::string& rule, std::size_t index) {
    if (!holds && fault_.empty()) fault_ = rule + " at " + std::to_string(index);
    return holds;
  }

  void slots() {
    if (!expect(o_.slot_of.size() == particles_, "one slot per particle", 0)) return;
    std::size_t held = 0;
    for (const std::uint32_t particle : o_.particle_at) held += particle != kNoIndex ? 1 : 0;
    expect(held == particles_, "a particle per slot", held);
    for (std::uint32_t p = 0; p < particles_; ++p) {
      const std::uint32_t slot = o_.slot_of[p];
      expect(slot < o_.slots() && o_.particle_at[slot] == p, "slot_of inverts particle_at", p);
    }
    expect(o_.slots() % kLanes == 0, "slots fill lanes", o_.slots());
  }

  void constraints() {
    const std::size_t count = o_.constraint_slots();
    if (!expect(o_.a.size() == count && o_.b.size() == count, "two ends", count)) return;
    std::vector<int> seen(links_.size());
    for (std::size_t c = 0; c < count; ++c) {
      if (!expect(o_.a[c] < o_.slots() && o_.b[c] < o_.slots(), "ends are slots", c)) return;
      if (o_.link_at[c] == kNoIndex) continue;
      const Link& link = links_[o_.link_at[c]];
      const std::uint32_t a = o_.particle_at[o_.a[c]], b = o_.particle_at[o_.b[c]];
      expect(std::minmax(a, b) == std::minmax(link.a, link.b), "ends are the link's", c);
      ++seen[o_.link_at[c]];
    }
    for (std::size_t i = 0; i < seen.size(); ++i) expect(seen[i] == 1, "every link once", i);
  }

  void tiles() {
    std::uint32_t slot = 0, batch = 0;
    for (std::size_t t = 0; t < o_.tiles.size(); ++t) {
      const Tile& tile = o_.tiles[t];
      expect(tile.first_slot == slot && tile.last_slot >= slot, "tiles follow each other", t);
      expect(tile.last_slot % kLanes == 0, "tiles fill lanes", t);
      expect(tile.first_batch == batch && tile.last_batch >= batch, "tiles' batches follow", t);
      for (std::uint32_t i = tile.first_batch; i < tile.last_batch; ++i) within(tile, i);
      slot = tile.last_slot;
      batch = tile.last_batch;
    }
    expect(slot <= o_.slots(), "tiles are slots", slot);
    for (std::size_t s = slot; s < o_.slots(); ++s) {
      expect(o_.particle_at[s] == kNoIndex, "only padding beyond the tiles", s);
    }
    expect(o_.between_tiles == batch, "then batches between tiles", batch);
    expect(batch <= o_.batches.size(), "tiles' batches exist", batch);
  }

  void within(const Tile& tile, std::uint32_t i) {
    const auto inside = [&](std::uint32_t s) { return s >= tile.first_slot && s < tile.last_slot; };
    for (std::uint32_t c = o_.batches[i].first; c < o_.batches[i].last; ++c) {
      expect(inside(o_.a[c]) && inside(o_.b[c]), "a tile's constraints stay in it", c);
    }
  }

  void batches() {
    std::uint32_t constraint = 0, run = 0;
    std::vector<std::size_t> used_in(o_.slots(), o_.batches.size());
    for (std::size_t i = 0; i < o_.batches.size(); ++i) {
      const Batch& batch = o_.batches[i];
      expect(batch.first == constraint && batch.first < batch.last, "batches follow", i);
      expect(batch.first_run == run && batch.last_run >= run, "batches' runs follow", i);
      expect((batch.last - batch.singles) % kLanes == 0, "singles fill lanes", i);
      expect(batch.colour < o_.colours, "colours are counted", i);
      runs(batch, i);
      links(batch, i, used_in);
      constraint = batch.last;
      run = batch.last_run;
    }
    expect(constraint == o_.constraint_slots(), "batches are all constraints", constraint);
    expect(run == o_.runs.size(), "batches have all runs", run);
  }

  void runs(const Batch& batch, std::size_t i) {
    std::uint32_t next = batch.first;
    for (std::uint32_t r = batch.first_run; r < batch.last_run; ++r) {
      const Run& run = o_.runs[r];
      expect(run.constraint == next, "runs follow each other", r);
      expect(run.length > 0 && run.length % kLanes == 0, "runs fill lanes", r);
      for (std::uint32_t k = 0; k < run.length; ++k) {
        const std::uint32_t c = run.constraint + k;
        expect(o_.a[c] == run.a + k && o_.b[c] == run.b + k, "runs advance by one", c);
      }
      next += run.length;
    }
    expect(next == batch.singles, "singles follow the runs", i);
  }

  void links(const Batch& batch, std::size_t i, std::vector<std::size_t>& used_in) {
    for (std::uint32_t c = batch.first; c < batch.last; ++c) {
      for (const std::uint32_t slot : {o_.a[c], o_.b[c]}) {
        expect(used_in[slot] != i, "no slot twice in a batch", c);
        used_in[slot] = i;
      }
      const std::uint32_t link = o_.link_at[c];
      if (link != kNoIndex) expect(links_[link].kind == batch.kind, "one kind in a batch", c);
      if (c < batch.singles || link != kNoIndex) continue;
      expect(o_.particle_at[o_.a[c]] == kNoIndex && o_.particle_at[o_.b[c]] == kNoIndex,
             "padding of singles joins padding", c);
    }
  }

  void colours() {
    std::set<std::uint32_t> used;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at;  // particle, colour
    for (const Batch& batch : o_.batches) {
      used.insert(batch.colour);
      for (std::uint32_t c = batch.first; c < batch.last; ++c) {
        if (o_.link_at[c] == kNoIndex) continue;
        at.push_back({o_.particle_at[o_.a[c]], batch.colour});
        at.push_back({o_.particle_at[o_.b[c]], batch.colour});
      }
    }
    std::sort(at.begin(), at.end());
    const auto twice = std::adjacent_find(at.begin(), at.end());
    expect(twice == at.end(), "colours are unique at a particle",
           twice == at.end() ? 0 : twice->first);
    expect(used.size() == o_.colours, "every colour is used", used.size());
    for (std::size_t i = 0; i < o_.between_tiles; ++i) {
      for (std::size_t k = o_.between_tiles; k < o_.batches.size(); ++k) {
        expect(o_.batches[i].colour < o_.batches[k].colour, "between tiles: own colours", k);
      }
    }
  }

  void share() {
    std::size_t in_runs = 0;
    for (const Run& run : o_.runs) {
      for (std::uint32_t k = 0; k < run.length; ++k) {
        in_runs += o_.link_at[run.constraint + k] != kNoIndex ? 1 : 0;
      }
    }
    const double share =
        links_.empty() ? 1 : static_cast<double>(in_runs) / static_cast<double>(links_.size());
    expect(share == o_.run_share, "run_share is what it says", in_runs);
  }

  const Ordering& o_;
  std::span<const Link> links_;
  std::size_t particles_;
  std::string fault_;
};

}  // namespace

std::string fault_of(const Ordering& ordering, std::span<const Link> links, std::size_t particles) {
  return Check(ordering, links, particles).fault();
}

}  // namespace weft::test
