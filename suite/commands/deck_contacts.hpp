#pragma once

#include "io/hdf5_file.hpp"
#include "problem/scene.hpp"

namespace sandglass {

/// Writes what a deck needs of contact: groups /problem/obstacles/I and /problem/contacts/I with the keys of
/// their tables in a case (numbers and vectors as datasets, words as attributes), `faces` (n, 4) of the body,
/// of a pair also `other_faces`, of a surface its `points` (m) and `triangles`, and `stiffness`, the pressure
/// per depth of their penalty, Pa/m. Obstacles are where they start; `displacement` (m) is their whole way,
/// and `overlap` (m) how deep the undeformed body is inside at its end. Throws InputError for curves other
/// than the case's that the answer depends on.
void write_contacts(const Scene& scene, Hdf5File& file);

}  // namespace sandglass
