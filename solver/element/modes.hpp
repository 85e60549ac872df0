#pragma once

#include <algorithm>

#include "mesh/hexahedron.hpp"

/// The modal form of nodal values. Trilinear fields are spanned by one translation, three linear and four
/// hourglass modes whose nodal values are +1 or -1, so that the transformation and its transpose consist of
/// additions. Every mode is the sum or difference of a mode of two opposite faces.
namespace sandglass {

/// Amplitudes of the seven modes that deform an element, each with three components: rows 0 to 2 belong to
/// xi, eta, zeta, rows 3 to 6 to the hourglass modes eta zeta, xi zeta, xi eta, xi eta zeta. They are sums
/// over the nodes.
template <class T>
using Modes = Matrix<T, 7, 3>;

/// Three components for each of the four hourglass modes: hourglass displacements q_ai, or resistances Q_ai.
template <class T>
using HourglassModes = Matrix<T, 4, 3>;

/// Sums over the four nodes of a face with the signs of 1, xi, eta and xi eta, which both elements that share
/// the face use. Corners are in the order of the lower face of a VTK hexahedron.
template <class T>
using FaceModes = Matrix<T, 4, 3>;

/// Three components at each of the four nodes of a face.
template <class T>
using FaceVectors = Matrix<T, 4, 3>;

/// The eight nodes of an element from its two faces.
template <class T>
constexpr NodalVectors<T> nodes_of(const FaceVectors<T>& lower, const FaceVectors<T>& upper) {
  NodalVectors<T> u;
  std::copy(lower.entries.begin(), lower.entries.end(), u.entries.begin());
  std::copy(upper.entries.begin(), upper.entries.end(), u.entries.begin() + 12);
  return u;
}

/// The lower and the upper face of an element.
template <class T>
constexpr std::array<FaceVectors<T>, 2> faces(const NodalVectors<T>& u) {
  std::array<FaceVectors<T>, 2> halves;
  std::copy_n(u.entries.begin(), 12, halves[0].entries.begin());
  std::copy_n(u.entries.begin() + 12, 12, halves[1].entries.begin());
  return halves;
}

/// sum_I s_mI u_I of a face: a butterfly of 8 additions per component.
template <class T>
constexpr FaceModes<T> to_face_modes(const FaceVectors<T>& u) {
  FaceModes<T> modes;
  for (int i = 0; i < 3; ++i) {
    const T s0 = u(0, i) + u(1, i), d0 = u(1, i) - u(0, i);
    const T s1 = u(3, i) + u(2, i), d1 = u(2, i) - u(3, i);
    modes(0, i) = s0 + s1;
    modes(1, i) = d0 + d1;
    modes(2, i) = s1 - s0;
    modes(3, i) = d1 - d0;
  }
  return modes;
}

/// The transpose of `to_face_modes`: again 8 additions per component.
template <class T>
constexpr FaceVectors<T> from_face_modes(const FaceModes<T>& a) {
  FaceVectors<T> f;
  for (int i = 0; i < 3; ++i) {
    const T s0 = a(0, i) - a(2, i), s1 = a(0, i) + a(2, i);
    const T d0 = a(1, i) - a(3, i), d1 = a(1, i) + a(3, i);
    f(0, i) = s0 - d0;
    f(1, i) = s0 + d0;
    f(3, i) = s1 - d1;
    f(2, i) = s1 + d1;
  }
  return f;
}

/// The modes of the element between two faces: 7 additions per component.
template <class T>
constexpr Modes<T> modes_between(const FaceModes<T>& lower, const FaceModes<T>& upper) {
  Modes<T> modes;
  for (int i = 0; i < 3; ++i) {
    modes(0, i) = lower(1, i) + upper(1, i);
    modes(1, i) = lower(2, i) + upper(2, i);
    modes(2, i) = upper(0, i) - lower(0, i);
    modes(3, i) = upper(2, i) - lower(2, i);
    modes(4, i) = upper(1, i) - lower(1, i);
    modes(5, i) = lower(3, i) + upper(3, i);
    modes(6, i) = upper(3, i) - lower(3, i);
  }
  return modes;
}

/// The part of an element's modal forces f that acts on its upper face, from the transpose of
/// `modes_between`.
template <class T>
constexpr FaceModes<T> upper_face(const Modes<T>& f) {
  FaceModes<T> face;
  for (int i = 0; i < 3; ++i) {
    face(0, i) = f(2, i);
    face(1, i) = f(0, i) + f(4, i);
    face(2, i) = f(1, i) + f(3, i);
    face(3, i) = f(5, i) + f(6, i);
  }
  return face;
}

/// The part that acts on its lower face.
template <class T>
constexpr FaceModes<T> lower_face(const Modes<T>& f) {
  FaceModes<T> face;
  for (int i = 0; i < 3; ++i) {
    face(0, i) = -f(2, i);
    face(1, i) = f(0, i) - f(4, i);
    face(2, i) = f(1, i) - f(3, i);
    face(3, i) = f(5, i) - f(6, i);
  }
  return face;
}

/// The parts of a nodal quantity that belong to an element's lower and upper face.
template <class Face>
struct FacePair {
  Face lower;
  Face upper;
};

/// Modal forces by faces.
template <class T>
constexpr FacePair<FaceModes<T>> on_faces(const Modes<T>& f) {
  return {lower_face(f), upper_face(f)};
}

/// sum_I s_mI u_I for each mode m of an element, s its nodal signs.
template <class T>
constexpr Modes<T> to_modes(const NodalVectors<T>& u) {
  const auto [lower, upper] = faces(u);
  return modes_between(to_face_modes(lower), to_face_modes(upper));
}

/// sum_m s_mI a_m at each node I: the transpose of `to_modes`.
template <class T>
constexpr NodalVectors<T> from_modes(const Modes<T>& a) {
  return nodes_of(from_face_modes(lower_face(a)), from_face_modes(upper_face(a)));
}

}  // namespace sandglass
