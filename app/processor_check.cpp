/// Ends the program if the processor lacks the instructions that all other files use. This file is compiled
/// for every x86-64 processor and calls no inline function that another file may have compiled with other
/// flags. It runs before the initialisers of all other files, which may already use these instructions.

#include <unistd.h>

namespace {

[[gnu::constructor(101)]] void require_instructions() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return;
  constexpr char message[] =
      "error: this processor lacks instructions of x86-64-v3 (AVX2, FMA, BMI2), which this build of "
      "sandglass needs; "
      "build it from source for this processor, with the preset release\n";
  if (write(STDERR_FILENO, message, sizeof message - 1)) {
  }
  _exit(3);
}

}  // namespace
