#include <fmt/format.h>

#include "app/commands.hpp"
#include "element/methods.hpp"

namespace sandglass {

void add_methods_command(CLI::App& app) {
  app.add_subcommand("methods", "list the methods, one line each")->callback([] {
    for_each_type(Methods{}, []<class Method>() {
      fmt::print("{:<24} {:<8} {}\n", Method::name, Method::Hourglass::takes_kappa ? "--kappa" : "",
                 Method::summary);
    });
  });
}

}  // namespace sandglass
