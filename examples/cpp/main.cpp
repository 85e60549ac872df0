// A tool moves a set of nodes of a soft body for one second in 1000 frames, as in a haptic loop:
//   step_a_scene CASE SET X Y Z      X Y Z is the final displacement (m)
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sandglass/simulation.hpp>

int main(int argc, char** argv) {
  if (argc != 6) return std::fprintf(stderr, "usage: step_a_scene CASE SET X Y Z\n"), 2;
  const double end[]{std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5])};
  try {
    sandglass::Simulation<double> body(argv[1]);
    const auto u = body.displacements();  // a view of the time loop's array: always current
    std::vector<std::size_t> drawn;       // rows of the nodes to print: every tenth
    for (std::size_t n = 0; n < u.rows; n += 10) drawn.push_back(std::size_t(body.row_of_node()[n]));

    for (int frame = 1; frame <= 1000; ++frame) {
      const double t = frame / 1000.0, share = t * t * t * (10 + t * (6 * t - 15));  // smooth at both ends
      body.move(argv[2], {share * end[0], share * end[1], share * end[2]});
      body.advance(0.001);
      if (frame % 100 != 0) continue;
      const auto force = body.reaction(argv[2]);
      std::printf("%.3f s, force %.6e %.6e %.6e N\n", body.time(), force[0], force[1], force[2]);
      for (const std::size_t r : drawn) std::printf("  %.17g %.17g %.17g\n", u[r][0], u[r][1], u[r][2]);
    }
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 3;
  }
}
