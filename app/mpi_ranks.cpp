#include "app/mpi_ranks.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>

#include "base/error.hpp"
#include "io/hdf5_file.hpp"

#ifdef SANDGLASS_MPI
#include <hdf5.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>
#endif

namespace sandglass {

#ifdef SANDGLASS_MPI

namespace {

/// The most numbers that MPI counts in one call.
constexpr std::size_t most = std::size_t{1} << 30;

class MpiRanks final : public Ranks, public WritesHdf5Together {
 public:
  MpiRanks() {
    int given = 0;  // only the main thread calls MPI
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm_dup(MPI_COMM_WORLD, &endings_);
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;
  ~MpiRanks() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int count() const override { return count_; }
  Traffic traffic() const override { return traffic_; }

  void start(const Exchange& exchange) const override {
    const int below = rank_ > 0 ? rank_ - 1 : MPI_PROC_NULL;
    const int above = rank_ + 1 < count_ ? rank_ + 1 : MPI_PROC_NULL;
    const auto receive = [](std::span<std::byte> to, int from, MPI_Request& request) {
      MPI_Irecv(to.data(), static_cast<int>(to.size()), MPI_BYTE, from, 0, MPI_COMM_WORLD, &request);
    };
    ++traffic_.exchanges;
    const auto send = [this](std::span<const std::byte> from, int to, MPI_Request& request) {
      if (!from.empty()) ++traffic_.messages;
      traffic_.bytes += static_cast<long>(from.size());
      MPI_Isend(from.data(), static_cast<int>(from.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD, &request);
    };
    receive(exchange.from_below, below, requests_[0]);
    receive(exchange.from_above, above, requests_[1]);
    send(exchange.to_below, below, requests_[2]);
    send(exchange.to_above, above, requests_[3]);
  }

  void finish() const override {
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  }

  void sum(std::span<double> numbers) const override {
    for (; !numbers.empty(); numbers = numbers.subspan(std::min(most, numbers.size()))) {
      MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(std::min(most, numbers.size())),
                    MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    }
  }

  void gather(std::byte* data, std::span<const std::size_t> bounds) const override {
    for (int root = 0; root < count_; ++root) {
      const std::size_t end = bounds[static_cast<std::size_t>(root) + 1];
      for (std::size_t at = bounds[static_cast<std::size_t>(root)]; at < end; at += most) {
        MPI_Bcast(data + at, static_cast<int>(std::min(most, end - at)), MPI_BYTE, root, MPI_COMM_WORLD);
      }
    }
  }

  void open_together(std::int64_t access) const override {
    if (count_ > 1) H5Pset_fapl_mpio(access, MPI_COMM_WORLD, MPI_INFO_NULL);
  }

  void write_together(std::int64_t transfer) const override {
    if (count_ > 1) H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  }

  bool all_end() const override {
    using namespace std::chrono_literals;
    MPI_Request request;
    MPI_Ibarrier(endings_, &request);
    int all = 0;
    for (int waited = 0; waited < 100; ++waited) {
      MPI_Test(&request, &all, MPI_STATUS_IGNORE);
      if (all != 0) return true;
      std::this_thread::sleep_for(20ms);
    }
    return false;
  }

  void abort(int exit_code) const override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

 private:
  int rank_ = 0;
  int count_ = 1;
  MPI_Comm endings_{};
  mutable std::array<MPI_Request, 4> requests_{};
  mutable Traffic traffic_;
};

}  // namespace

std::shared_ptr<const Ranks> join_ranks() {
  return std::make_shared<const MpiRanks>();
}

#else

std::shared_ptr<const Ranks> join_ranks() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* given = std::getenv(size);
    if (given == nullptr || std::atoi(given) <= 1) continue;
    throw InputError(
        fmt::format("ranks: {} were started, but this program was built without MPI; build it with "
                    "-DSANDGLASS_MPI=ON, or use --threads",
                    given));
  }
  return std::make_shared<const Ranks>();
}

#endif

void warn_if_bound(const Ranks& ranks, int threads) {
  const int processors = omp_get_num_procs();  // available to this process
  const bool by_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  if (!by_mpirun || ranks.rank() > 0 || threads <= processors) return;
  fmt::print(stderr, "warning: the {} threads of a rank share {} processor{}; give mpirun --bind-to none\n",
             threads, processors, processors == 1 ? "" : "s");
}

}  // namespace sandglass
