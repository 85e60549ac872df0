#pragma once

#include <algorithm>
#include <atomic>
#include <barrier>
#include <memory>
#include <thread>
#include <vector>

#include "base/ranks.hpp"

namespace sandglass::verification {

/// Ranks as threads of one program, which share nothing but their messages, for tests without MPI.
class ThreadRanks {
 public:
  explicit ThreadRanks(int count) : arrived_(count) {
    for (int rank = 0; rank < count; ++rank) {
      ranks_.push_back(std::make_shared<Member>(*this, rank, count));
    }
  }

  /// Calls work(ranks) on every rank, and returns the results.
  template <class Work>
  auto run(const Work& work) {
    std::vector<decltype(work(std::shared_ptr<const Ranks>()))> results(ranks_.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t r = 0; r < ranks_.size(); ++r) {
        threads.emplace_back([&, r] { results[r] = work(ranks_[r]); });
      }
    }
    return results;
  }

  /// Messages of a rank, and the number of sums and gathers in which it took part.
  Ranks::Traffic traffic(std::size_t rank) const { return ranks_[rank]->sent; }
  long collectives(std::size_t rank) const { return ranks_[rank]->collectives; }

 private:
  struct Member final : Ranks {
    Member(ThreadRanks& all_ranks, int number, int of) : all(all_ranks), own(number), members(of) {}

    int rank() const override { return own; }
    int count() const override { return members; }

    void start(const Exchange& exchange) const override { pending = exchange; }

    void finish() const override {
      all.arrived_.arrive_and_wait();
      if (own > 0) copy(other(own - 1).pending.to_above, pending.from_below);
      if (own + 1 < members) copy(other(own + 1).pending.to_below, pending.from_above);
      ++sent.exchanges;
      for (const auto& part : {pending.to_below, pending.to_above}) {
        sent.messages += part.empty() ? 0 : 1;
        sent.bytes += static_cast<long>(part.size());
      }
      all.arrived_.arrive_and_wait();
    }

    void sum(std::span<double> numbers) const override {
      published.assign(numbers.begin(), numbers.end());
      all.arrived_.arrive_and_wait();
      std::fill(numbers.begin(), numbers.end(), 0.0);
      for (int r = 0; r < members; ++r) {
        for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] += other(r).published[n];
      }
      ++collectives;
      all.arrived_.arrive_and_wait();
    }

    void gather(std::byte* data, std::span<const std::size_t> bounds) const override {
      gathered = data;
      all.arrived_.arrive_and_wait();
      for (int r = 0; r < members; ++r) {
        const std::size_t first = bounds[static_cast<std::size_t>(r)],
                          last = bounds[static_cast<std::size_t>(r) + 1];
        if (r != own) std::copy(other(r).gathered + first, other(r).gathered + last, data + first);
      }
      ++collectives;
      all.arrived_.arrive_and_wait();
    }

    const Member& other(int r) const { return *all.ranks_[static_cast<std::size_t>(r)]; }

    static void copy(std::span<const std::byte> from, std::span<std::byte> to) {
      if (from.size() != to.size()) std::terminate();  // ranks disagree
      std::copy(from.begin(), from.end(), to.begin());
    }

    ThreadRanks& all;
    int own;
    int members;
    mutable Exchange pending;
    mutable std::vector<double> published;
    mutable std::byte* gathered = nullptr;
    mutable Traffic sent;
    mutable long collectives = 0;
  };

  std::barrier<> arrived_;
  std::vector<std::shared_ptr<Member>> ranks_;
};

}  // namespace sandglass::verification
