/// Messages about case files with mistakes: they name the file, the key, the value and the rule.

#include <gtest/gtest.h>

#include <ostream>

#include "comparison/comparison.hpp"
#include "io/case_file.hpp"
#include "support/good_case.hpp"
#include "support/temporary_folder.hpp"

namespace sandglass::verification::refused_case_test {
namespace {

using good_case::good, good_case::own_mesh, good_case::two_bodies, good_case::with;

/// `good` in motion.
const std::string moving = with("\"quasi-static\"", "\"dynamic\"") + "[dynamics]\nduration = 2.0\n";

const std::string published =
    "[[published]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n";
std::string measured(const std::string& keys) {
  return "[[measured]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n" + keys;
}

/// An obstacle above the body.
const std::string pressed =
    "[[obstacle]]\nname = \"tool\"\nset = \"top\"\nshape = \"plane\"\npoint = [0, 0, 4.0]\n"
    "normal = [0, 0, -1.0]\n";

/// A published force.
std::string force(const std::string& of, const std::string& component) {
  return fmt::format("[[published]]\n{}\ncomponent = \"{}\"\nvalue = 1.0\nsource = \"a\"\n", of, component);
}
const std::string program = "[[published.programs]]\nprogram = \"b\"\nsource = \"c\"\n";

struct BadCase {
  const char* name;
  std::string text;
  std::vector<std::string> said;  ///< required parts of the message, besides the file's name
};

void PrintTo(const BadCase& bad, std::ostream* stream) {
  *stream << bad.name;
}

class BadCaseTest : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadCaseTest, is_refused_with_file_key_value_and_rule) {
  const TemporaryFolder folder;
  const auto file = folder.write("bad.toml", GetParam().text);
  const std::string text = input_error([&] { read_comparison(read_scene(file)); });
  EXPECT_TRUE(contains(text, file.string()));
  for (const auto& part : GetParam().said) EXPECT_TRUE(contains(text, part));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadCaseTest,
    ::testing::Values(
        BadCase{"not_toml", "[case\nname = 3", {":1: is not TOML"}},
        BadCase{"empty_file", "", {"case is missing"}},
        BadCase{"unknown_key",
                with("tolerance = 1e-7", "tolerence = 1e-7"),
                {"bad.toml:35: relaxation.tolerence", "did you mean 'tolerance'?"}},
        BadCase{"unknown_table", good + "[wind]\ng = 9.81\n", {"wind is not a key"}},
        BadCase{"misspelt_required_key",
                with("young_modulus = ", "young_moduls = "),
                {"material.young_moduls", "did you mean 'young_modulus'?"}},
        BadCase{"missing_key", with("density = 1000.0\n", ""), {"material.density is missing"}},
        BadCase{"missing_table", with("[mesh]\n" + own_mesh + "\n", ""), {"mesh is missing"}},
        BadCase{"text_for_a_number",
                with("young_modulus = 3000.0", "young_modulus = \"soft\""),
                {"bad.toml:13: material.young_modulus = 'soft' must be a number"}},
        BadCase{"fraction_for_an_integer",
                with("elements = [1, 2, 3]", "elements = [1, 2.5, 3]"),
                {"mesh.elements = [1, 2.5, 3] must be a list of 3, each an integer"}},
        BadCase{"two_entries_for_three",
                with("size = [1.0, 2.0, 3.0]", "size = [0.04, -0.05]"),
                {"mesh.size = [0.04, -0.05] must be a list of 3"}},
        BadCase{"number_for_a_table",
                with("bottom = { z = [0.0, 0.0] }", "bottom = 3"),
                {"sets.bottom = 3 must be a table"}},
        BadCase{"poisson_ratio_half",
                with("poisson_ratio = 0.49", "poisson_ratio = 0.5"),
                {"material.poisson_ratio = 0.5 must be in (-1, 0.5)"}},
        BadCase{"fibres_without_a_direction",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibre_direction = [0, 0.0, 0]"),
                {"bad.toml:14: material.fibre_direction", "[0, 0, 0]", "length must not be zero"}},
        BadCase{"fibres_missing",
                with("law = \"neo-hookean\"", "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0"),
                {"material.fibre_direction or fibres must be given", "fibre-neo-hookean"}},
        BadCase{"fibres_of_an_isotropic_law",
                with("law = \"neo-hookean\"", "law = \"neo-hookean\"\nfibre_direction = [0, 0, 1]"),
                {"material.fibre_direction was given", "neo-hookean", "isotropic"}},
        BadCase{"sheets_along_fibres",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibre_direction = [0, 0, 1]\n"
                     "sheet_direction = [0, 0, -2]"),
                {"material.fibre_direction", "sheets and fibres have the same direction"}},
        BadCase{"radii_that_decrease",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\n"
                     "fibres = { axis = \"z\", radii = [0.2, 0.1], angles = [60, -60] }"),
                {"material.fibres.radii = [0.2, 0.1] must increase"}},
        BadCase{"file_of_fibres_missing",
                with("law = \"neo-hookean\"",
                     "law = \"fibre-neo-hookean\"\nfibre_modulus = 1.0\nfibres = { file = \"none.txt\" }"),
                {"none.txt: cannot be read"}},
        BadCase{"volumetric_part_unknown",
                with("density = 1000.0", "density = 1000.0\nvolumetric = \"cubic\""),
                {"material.volumetric = 'cubic'", "logarithmic"}},
        BadCase{"volumetric_part_of_a_law_that_has_none",
                with("law = \"neo-hookean\"", "law = \"st-venant-kirchhoff\"\nvolumetric = \"logarithmic\""),
                {"material.volumetric must be left out", "st-venant-kirchhoff"}},
        BadCase{"rule_between_parameters",
                with("law = \"neo-hookean\"\nyoung_modulus = 3000.0\npoisson_ratio = 0.49",
                     "law = \"yeoh\"\nc1 = 100.0\nc2 = -30.0\nc3 = 2.0\nbulk_modulus = 1e4"),
                {"bad.toml:14: material.c2 = -30 must be at least 0", "3 c1 c3 = 600"}},
        BadCase{"poisson_ratio_above",
                with("poisson_ratio = 0.49", "poisson_ratio = 0.6"),
                {"= 0.6 must be in (-1, 0.5)"}},
        BadCase{"poisson_ratio_minus_one",
                with("poisson_ratio = 0.49", "poisson_ratio = -1"),
                {"= -1 must be in (-1, 0.5)"}},
        BadCase{"poisson_ratio_nan",
                with("poisson_ratio = 0.49", "poisson_ratio = nan"),
                {"= nan must be in (-1, 0.5)"}},
        BadCase{"young_modulus_zero",
                with("young_modulus = 3000.0", "young_modulus = 0.0"),
                {"material.young_modulus = 0 must be in (0, inf)"}},
        BadCase{"young_modulus_infinite",
                with("young_modulus = 3000.0", "young_modulus = inf"),
                {"= inf must be in (0, inf)"}},
        BadCase{"density_negative",
                with("density = 1000.0", "density = -1.0"),
                {"material.density = -1 must be in (0, inf)"}},
        BadCase{"no_elements",
                with("elements = [1, 2, 3]", "elements = [1, 0, 3]"),
                {"mesh.elements = 0 must be in [1, inf)"}},
        BadCase{"tolerance_negative",
                with("tolerance = 1e-7", "tolerance = -1.0"),
                {"relaxation.tolerance = -1"}},
        BadCase{"kappa_negative",
                with("kappas = [0.01, 0.02]", "kappas = [0.01, -0.02]"),
                {"comparison.kappas = -0.02"}},
        BadCase{"kappa_unknown_word",
                with("kappa = 0.01", "kappa = \"automatic\""),
                {"expect.kappa", "auto, best"}},
        BadCase{"unknown_law",
                with("law = \"neo-hookean\"", "law = \"neo-hokean\""),
                {"material.law = 'neo-hokean' is not known", "did you mean 'neo-hookean'?"}},
        BadCase{"body_without_name",
                replaced(two_bodies, "name = \"two\"", "name = \"\""),
                {"mesh.bodies.name = '' must be a word without '/'"}},
        BadCase{"two_bodies_of_one_name",
                replaced(two_bodies, "\"two\"", "\"one\""),
                {"mesh.bodies.name = 'one' appears twice; every body needs its own name"}},
        BadCase{"bodies_that_overlap",
                replaced(two_bodies, "offset = [0.0, 0.0, 3.0]", "offset = [0.1, 0.0, 2.0]"),
                {"mesh.bodies: the point (", "is in two bodies; allowed: bodies that do not intersect"}},
        BadCase{"bodies_beside_a_generator",
                replaced(two_bodies, "[[mesh.bodies]]\nname = \"one\"",
                         "[mesh]\ngenerator = \"box\"\n\n[[mesh.bodies]]\nname = \"one\""),
                {"mesh.generator is not a key"}},
        BadCase{"misspelt_key_of_a_body",
                replaced(two_bodies, "offset", "ofset"),
                {"mesh.bodies.ofset", "did you mean 'offset'?"}},
        BadCase{"focus_outside_of_the_ball",
                with(own_mesh,
                     "generator = \"ellipsoid\"\nsemi_axes = [1.0, 1.0, 1.0]\ncore_elements = 2\n"
                     "shell_layers = 1\nfocus = [0.8, 0.6, 0.0]"),
                {"mesh.focus = [0.8, 0.6, 0] must be in the unit ball"}},
        BadCase{"unknown_generator",
                with("generator = \"box\"", "generator = \"torus\""),
                {"mesh.generator = 'torus' is not known", "known: box, ellipsoid, cylinder"}},
        BadCase{"unknown_method",
                with("method = \"tl-perturbation\"", "method = \"tl-nothing\""),
                {"expect.method = 'tl-nothing'", "nearest of 20: tl-none"}},
        BadCase{"unknown_answer",
                with("\"quasi-static\"", "\"static\""),
                {"case.answer = 'static'", "quasi-static, dynamic"}},
        BadCase{"both_limits", with("below = 0.01", "below = 0.01\nabove = 0.5"), {"below", "but not both"}},
        BadCase{"no_limit", with("below = 0.01\n", ""), {"below", "but not both"}},
        BadCase{"empty_set",
                with("top = { z = [3.0, 3.0] }", "top = { z = [4.0, 5.0] }"),
                {"sets.top selects no node"}},
        BadCase{"interval_turned",
                with("top = { z = [3.0, 3.0] }", "top = { z = [5.0, 4.0] }"),
                {"sets.top.z", "low end first"}},
        BadCase{"set_of_a_displacement",
                with("set = \"top\"\nvalue", "set = \"tap\"\nvalue"),
                {"displacement.set = 'tap' is not a node set", "did you mean 'top'?"}},
        BadCase{"set_of_the_profile",
                with("set = \"top\"\norder", "set = \"tip\"\norder"),
                {"profile.set = 'tip'"}},
        BadCase{"wrong_component",
                with("components = \"xz\"", "components = \"xw\""),
                {"displacement.components = 'xw'"}},
        BadCase{"component_named_twice",
                with("components = \"xz\"", "components = \"xx\""),
                {"displacement.components = 'xx' must consist of x, y, z, each once"}},
        BadCase{"no_component",
                with("components = \"xz\"", "components = \"\""),
                {"displacement.components = '' must name at least one"}},
        BadCase{"value_that_is_not_imposed",
                good + "[[displacement]]\nset = \"top\"\nvalue = [0.0, 0.5, 0.0]\ncomponents = \"x\"\n",
                {"displacement.value has 0.5 m along y, which components = 'x' does not impose"}},
        BadCase{"motion_of_a_static_case",
                good + "[dynamics]\nduration = 1.0\n",
                {"dynamics is for motions", "answer = 'dynamic'"}},
        BadCase{"force_on_nothing",
                good + "[[force]]\nset = \"tip\"\ntotal = [0.0, 0.0, 1.0]\n",
                {"force.set = 'tip' is not a node set", "did you mean 'top'?"}},
        BadCase{"force_without_total_and_moment",
                good + "[[force]]\nset = \"top\"\n",
                {"force.total or moment must be given"}},
        BadCase{"infinite_force",
                good + "[[force]]\nset = \"top\"\ntotal = [0.0, inf, 1.0]\n",
                {"force.total = inf must be in (-inf, inf)"}},
        BadCase{"force_on_edges",
                good + "[[force]]\nset = \"top\"\ntotal = [0.0, 0.0, 1.0]\non = \"edges\"\n",
                {"force.on = 'edges' is not known", "faces, nodes"}},
        BadCase{"moment_on_nodes",
                good + "[[force]]\nset = \"top\"\nmoment = [0.0, 0.0, 1.0]\non = \"nodes\"\n",
                {"force.moment acts on faces"}},
        BadCase{"published_value_of_nothing",
                good + "[[published]]\nset = \"tip\"\ncomponent = \"x\"\nvalue = 1.0\nsource = \"a\"\n",
                {"published.set = 'tip' is not a node set"}},
        BadCase{"published_zero",
                good + "[[published]]\nset = \"top\"\ncomponent = \"x\"\nvalue = 0.0\nsource = \"a\"\n",
                {"published.value = 0 must not be zero"}},
        BadCase{"force_of_an_unknown_obstacle",
                good + force("obstacles = [\"tool\"]", "z"),
                {"published.obstacles: 'tool' is not an obstacle"}},
        BadCase{"force_of_a_set",
                good + force("obstacles = [\"tool\"]\nset = \"top\"", "z"),
                {"published.obstacles was given with set"}},
        BadCase{"mean_force_at_rest",
                good + pressed + force("obstacles = [\"tool\"]\nover = 0.1", "z"),
                {"published.over = 0.1 s is more than the duration"}},
        BadCase{"move_without_a_displacement",
                good + pressed + "[[obstacle.move]]\ntimes = [0.0]\nfactors = [1.0]\n",
                {"obstacle.move.displacement is missing"}},
        BadCase{"move_with_a_longer_list",
                good + pressed +
                    "[[obstacle.move]]\ndisplacement = [0, 0, 1]\ntimes = [0.0, 1.0]\nfactors = [1.0]\n",
                {"obstacle.move.times needs times and factors, one factor for each time"}},
        BadCase{
            "move_with_a_table_and_a_formula",
            good + pressed + "[[obstacle.move]]\ndisplacement = [0, 0, 1]\ntimes = [0.0]\nformula = \"t\"\n",
            {"obstacle.move.formula was given with times or factors"}},
        BadCase{"curve_of_no_displacement",
                good + pressed + "times = [0.0]\nfactors = [1.0]\n",
                {"obstacle.displacement is needed with times"}},
        BadCase{"force_around_an_axis",
                good + force("obstacles = [\"tool\"]", "around-z"),
                {"published.obstacles add up to a force, which has a component x, y or z"}},
        BadCase{"published_component",
                good + "[[published]]\nset = \"top\"\ncomponent = \"w\"\nvalue = 1.0\nsource = \"a\"\n",
                {"published.component = 'w' is not known", "x, y, z, around-x"}},
        BadCase{"program_without_a_source",
                good + published + "[[published.programs]]\nprogram = \"b\"\nvalues = [1.0]\n",
                {"published.programs.source is missing"}},
        BadCase{"program_with_an_unknown_key",
                good + published + program + "values = [1.0]\nmesh = [4]\n",
                {"published.programs.mesh is not a key of this table"}},
        BadCase{"program_with_a_value_too_few",
                good + published + program + "elements = [4, 8]\nvalues = [1.0]\n",
                {"published.programs.values has 1 numbers; 2 expected"}},
        BadCase{"program_with_no_mesh_and_two_values",
                good + published + program + "values = [1.0, 2.0]\n",
                {"published.programs.values has 2 numbers; 1 expected"}},
        BadCase{"measured_without_scatter", good + measured(""), {"measured.scatter is missing"}},
        BadCase{"measured_beside_the_plane_of_its_set",
                good + measured("scatter = 0.1\nat = [0.0, 0.0, 3.1]\n"),
                {"measured.at = [0, 0, 3.1] is not in the plane of the set 'top'"}},
        BadCase{"period_of_a_static_answer",
                good + measured("scatter = 0.1\nof = \"period\"\n"),
                {"measured.of = 'period' is for dynamic cases"}},
        BadCase{"unknown_feature",
                good + measured("scatter = 0.1\nof = \"phase\"\n"),
                {"measured.of = 'phase' is not known", "end, peak, period"}},
        BadCase{"scatter_of_a_published_value",
                good + published + "scatter = 0.1\n",
                {"published.scatter is not a key of this table"}},
        BadCase{"negative_mass",
                good + "[[mass]]\nset = \"top\"\ntotal = -1.0\n",
                {"mass.total = -1 must be in [0, inf)"}},
        BadCase{"mass_on_nothing",
                good + "[[mass]]\nset = \"tip\"\ntotal = 1.0\n",
                {"mass.set = 'tip' is not a node set"}},
        BadCase{"figure_of_another_reference",
                with("reference = \"golden\"", "reference = \"published\""),
                {"expect.figure = 'rms_relative_error' is not known", "relative_error"}},
        BadCase{"infinite_displacement",
                with("value = [0.5, 0.0, 0.3]", "value = [0.5, 0.0, inf]"),
                {"displacement.value = inf"}},
        BadCase{"node_driven_twice_differently",
                with("set = \"top\"\nvalue", "set = \"bottom\"\nvalue"),
                {"node 0 is given two displacements in x: 0 by set 'bottom' and 0.5 by set 'bottom'"}},
        BadCase{"velocity_of_a_static_answer",
                good + "[[velocity]]\nvalue = [0.0, 0.0, 1.0]\n",
                {"velocity is for motions", "answer = 'dynamic'"}},
        BadCase{"velocity_of_nothing",
                moving + "[[velocity]]\nset = \"tip\"\nvalue = [0.0, 0.0, 1.0]\n",
                {"velocity.set = 'tip' is not a node set", "did you mean 'top'?"}},
        BadCase{"velocity_without_value_and_spin",
                moving + "[[velocity]]\nset = \"top\"\n",
                {"velocity.value or spin must be given"}},
        BadCase{"infinite_spin",
                moving + "[[velocity]]\nspin = [0.0, inf, 1.0]\n",
                {"velocity.spin = inf must be in (-inf, inf)"}},
        BadCase{"negative_half_waves",
                moving + "[[velocity]]\nvalue = [0.0, 0.0, 1.0]\nhalf_waves = [0, -1, 0]\n",
                {"velocity.half_waves = -1 must be in [0, inf)"}},
        BadCase{"wave_without_extent",
                moving + "[[velocity]]\nset = \"top\"\nvalue = [0.0, 0.0, 1.0]\nhalf_waves = [0, 0, 1]\n",
                {"velocity.half_waves = 1 along z: the set top has no extent along z"}},
        BadCase{"key_of_old", moving + "[initial]\nvelocity = [0.0, 0.0, 1.0]\n", {"initial is not a key"}},
        BadCase{"dynamic_without_duration",
                with("\"quasi-static\"", "\"dynamic\"") + "[dynamics]\nframes = 3\n",
                {"dynamics.duration is missing"}}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace sandglass::verification::refused_case_test
