#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>

#include "base/joined_text.hpp"
#include "base/parameter.hpp"
#include "material/material_axes.hpp"
#include "material/memory.hpp"
#include "material/quadratic_volume.hpp"
#include "material/tangent_bound.hpp"
#include "math/strain.hpp"
#include "math/symmetric.hpp"

namespace sandglass {

inline constexpr std::string_view viscoelastic_prefix = "viscoelastic-";
inline constexpr std::string_view viscoelastic_suffix = "; shear stress relaxes with two times";

/// The factors of one Prony term in a step: Q <- Q + decay (share S_old - Q) + follow (S_new - S_old).
struct ViscousStep {
  double share;          ///< g, the share of the isochoric stress that finally decays
  double inverse_share;  ///< 1/g, or 0 if g is 0
  double decay;          ///< 1 - exp(-dt/tau)
  double follow;         ///< g (1 - (1 - exp(-dt/tau)) / (dt/tau))

  /// The factors of a step of `seconds`, 0 to infinite, for the relaxation time `time` (s). Both go to 0 with
  /// the step without cancellation, and to 1 and g when it is infinite.
  static ViscousStep of(double share, double time, double seconds) {
    if (!(share > 0.0)) return {0.0, 0.0, 0.0, 0.0};
    const double x = seconds / time;
    const double decay = -std::expm1(-x);
    return {share, 1.0 / share, decay, share * lag(x, decay)};
  }

 private:
  /// 1 - (1 - e^-x) / x = x/2! - x^2/3! + x^3/4! - ...; the series where the difference would cancel.
  static double lag(double x, double decay) {
    if (x > 0.5) return 1.0 - decay / x;
    double term = 0.5 * x;
    double sum = 0.0;
    for (int k = 3; k < 18; ++k) {  // x^16 / 17! is below the roundoff of x/2
      sum += term;
      term *= -x / k;
    }
    return sum;
  }
};

/// The memory of a viscoelastic law at a point, in the reference configuration, Pa.
template <class T>
struct ViscousMemory {
  Symmetric<T> S;                       ///< isochoric second Piola-Kirchhoff stress of the elastic law
  std::array<Symmetric<T>, 2> decayed;  ///< Q_i, the part of it that has decayed
};

/// A viscoelastic law at one point, with the interface of an elastic law. Stresses advance the memory by one
/// step; energies and bounds do not, and take a const `Memory`.
template <class Law, class Memory>
class ViscoelasticPoint : public VolumeOfElastic<ViscoelasticPoint<Law, Memory>> {
 public:
  ViscoelasticPoint(const Law& elastic, const std::array<ViscousStep, 2>& terms, Memory& memory)
      : elastic_(elastic), terms_(terms), memory_(memory) {}

  const Law& elastic() const { return elastic_; }

  /// V P (J) as for an elastic law, after one step in time: P = F (S_iso - sum_i Q_i) + p cof F.
  template <class T>
  Tensor<T> weighted_piola(const T& V, const Tensor<T>& H, const VolumeChange<T>& change, const T& p) const {
    return decayed_piola(elastic_.weighted_piola(T(1), H, change, T(0)), V, H, change, p);
  }

  /// The same from the elastic law's isochoric stress P (Pa).
  template <class T>
  Tensor<T> decayed_piola(const Tensor<T>& P, const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                          const T& p) const {
    const Tensor<T> cof_F = deformation_cofactor(H);
    const Tensor<T> Q = advance_memory(P, cof_F, change);
    const Tensor<T> HQ = H * Q;
    const T Vp = V * p;
    Tensor<T> VP;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) VP(i, j) = V * (P(i, j) - (Q(i, j) + HQ(i, j))) + Vp * cof_F(i, j);
    }
    return VP;
  }

  /// V tau = V P F^T (J) as for an elastic law, after one step in time.
  template <class T>
  Tensor<T> weighted_kirchhoff(const T& V, const Tensor<T>& H, const VolumeChange<T>& change,
                               const T& p) const {
    const Tensor<T> VP = weighted_piola(V, H, change, p);
    return VP + VP * transpose(H);
  }

  /// Stored isochoric energy (J/m^3) of the permanent spring and the springs of the Prony terms at the strain
  /// of the memory; the stresses of the latter are h_i = g_i S - Q_i:
  ///   W = g_inf W_iso + sum_i h_i : h_i / (4 g_i mu) * W_iso / (S : S / (4 mu)).
  /// The last factor, 1 near the undeformed state, is the compliance of the elastic law at this strain. The
  /// energy is elastic as long as nothing has decayed, g_inf times that when everything has, never negative,
  /// and exact for small strains; in between, at large strains, the model has no potential in closed form.
  template <class T>
  T isochoric_energy(const Tensor<T>& H) const {
    const T W = elastic_.isochoric_energy(H);
    const T tiny(1e-30 * elastic_.shear_modulus());  // 1, not 0/0, when undeformed
    const T quarter(0.25 / elastic_.shear_modulus());
    const T compliance = quarter * (W + tiny) / (quarter * norm_square(memory_.S) + tiny);
    T energy = T(remaining_share()) * W;
    for (std::size_t i = 0; i < 2; ++i) {
      energy = energy + T(terms_[i].inverse_share) * compliance * norm_square(spring_stress<T>(i));
    }
    return energy;
  }

  /// The elastic law's bound plus the bound of the stress in the memory. The stress after another step is (1
  /// - sum_i follow_i) S + R, R = -sum_i (b Q_i + (b - a) h_i), a = exp(-x), b = (1 - a) / x, x = dt/tau_i.
  /// The first part is softer than the elastic law; the second adds (F R F^T) : (L^T L) to the second
  /// variation, where max(|Q_i|, |h_i|) bounds each part for any step because b + (b - a) <= 1.
  template <class T>
  TangentBound<T> tangent_bound(const Tensor<T>& H, const T& J_minus_one, const T& p, const T& bulk) const {
    return viscoelastic_tangent_bound(elastic_, H, J_minus_one, p, bulk) + memory_bound(H);
  }

 private:
  template <class T>
  TangentBound<T> memory_bound(const Tensor<T>& H) const {
    TangentBound<T> bound{T(0), T(0)};
    for (std::size_t i = 0; i < 2; ++i) {
      const Tensor<T> a = to_space(full(memory_.decayed[i]), H), b = to_space(full(spring_stress<T>(i)), H);
      bound.gradient = bound.gradient + sqrt(max(double_dot(a, a), double_dot(b, b)));
    }
    return bound;
  }

  double remaining_share() const { return 1.0 - (terms_[0].share + terms_[1].share); }

  /// h_i, the remaining stress (Pa) of Prony term i.
  template <class T>
  Symmetric<T> spring_stress(std::size_t i) const {
    return T(terms_[i].share) * memory_.S - memory_.decayed[i];
  }

  /// Advances the memory by one step to the isochoric stress P = F S of the elastic law; returns sum_i Q_i.
  template <class T>
  Tensor<T> advance_memory(const Tensor<T>& P, const Tensor<T>& cof_F, const VolumeChange<T>& change) const {
    const T r = change.inverse_root;
    const Symmetric<T> S = (r * r * r) * symmetric_product(transpose(cof_F), P);  // F^-1 P
    const Symmetric<T> advance = S - memory_.S;
    Symmetric<T> sum;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto g = T(terms_[i].share), decay = T(terms_[i].decay), follow = T(terms_[i].follow);
      for (int n = 0; n < 6; ++n) {
        T& Q = memory_.decayed[i](n, 0);
        Q = Q + (decay * (g * memory_.S(n, 0) - Q) + follow * advance(n, 0));
        sum(n, 0) = i == 0 ? Q : sum(n, 0) + Q;
      }
    }
    memory_.S = S;
    return full(sum);
  }

  const Law& elastic_;
  const std::array<ViscousStep, 2>& terms_;
  Memory& memory_;
};

/// A viscoelastic law for one step in time, shared by all elements.
template <class Law>
class ViscoelasticStep {
 public:
  using Elastic = Law;

  ViscoelasticStep(const Law& elastic, const std::array<ViscousStep, 2>& terms)
      : elastic_(elastic), terms_(terms) {}

  /// The instantaneous response.
  const Law& elastic() const { return elastic_; }

  /// The law in elements with these axes.
  template <class T>
  auto with_axes(const MaterialAxes<T>* axes) const {
    return ViscoelasticStep<std::decay_t<decltype(sandglass::with_axes(elastic_, axes))>>(
        sandglass::with_axes(elastic_, axes), terms_);
  }

  /// The law at a point with this memory, const or not.
  template <class Memory>
  auto recalling(Memory& memory) const {
    return ViscoelasticPoint<Law, Memory>(elastic_, terms_, memory);
  }

 private:
  Law elastic_;
  std::array<ViscousStep, 2> terms_;
};

/// Viscoelasticity of any law by a Prony series of two terms: the isochoric second Piola-Kirchhoff stress
/// relaxes, the volumetric one does not,
///   S(t) = S_vol + g_inf S_iso + sum_i h_i,  h_i(t) = g_i int_0^t exp(-(t - s)/tau_i) dS_iso/ds ds,
/// with g_inf = 1 - sum_i g_i. In the reference frame no stress needs rotation: the law is objective. The
/// integral is exact for a stress that is linear in time over each step (Taylor, Pister and Goudreau 1970,
/// IJNME 2:45; Simo 1987, CMAME 60:153; for TLED: Taylor, Comas, Cheng, Passenger, Hawkes, Atkinson and
/// Ourselin 2009, Med. Image Anal. 13:234, who use a first-order step).
///
/// The memory stores the decayed part Q_i = g_i S_iso - h_i instead of h_i: S = S_elastic - sum_i Q_i. This
/// is the same in exact arithmetic, but in floating point it starts from zero: a body that has had no time to
/// relax is exactly elastic, and the small changes of a slow term are added to a small number. Each step
/// rounds Q by u |Q|, where u is half a unit in the last place, and damps earlier errors by exp(-dt/tau): the
/// error remains below a few u |Q| min(n, tau/dt) after n steps, in single precision as in double.
///
/// The parameters of the law, its moduli and its tangent bounds are those of the instantaneous response. So
/// is the stiffness of hourglass controls, which does not relax. Either choice has an error: a block bent by
/// a third of its length in half of tau_1, with 81 % of its stress relaxing, differs from the answer of
/// tl-mean-dilatation by 0.7 to 1.1 % when just bent and by 2.0 to 3.1 % when fully relaxed, and with
/// long-term moduli in the control by 2.5 to 6.0 % and 0.2 to 0.4 %. For slow loading only, multiply kappa by
/// g_inf.
template <class Law>
struct Viscoelastic : Law {
  static constexpr std::string_view name = joined_text<viscoelastic_prefix, Law::name>;
  static constexpr std::string_view summary = joined_text<Law::summary, viscoelastic_suffix>;
  static constexpr LawTraits traits = [] {
    LawTraits same = Law::traits;
    same.remembers = true;
    return same;
  }();

  double relaxation_1 = 0.0;
  double time_1 = 0.0;
  double relaxation_2 = 0.0;
  double time_2 = 0.0;

  template <class T>
  using Memory = ViscousMemory<T>;

  static constexpr auto parameters() {
    using Self = Viscoelastic;
    constexpr Range share{.low = 0.0, .high = 1.0, .low_open = false};
    return std::tuple_cat(
        inherited_parameters<Self>(Law::parameters()),
        std::tuple{
            Parameter{&Self::relaxation_1, "relaxation_1", "-", share,
                      "share of the instantaneous shear stress that relaxes in time_1"},
            Parameter{&Self::time_1, "time_1", "s", Range::positive(), "first relaxation time"},
            Parameter{&Self::relaxation_2, "relaxation_2", "-", share, "share that relaxes in time_2", false},
            Parameter{&Self::time_2, "time_2", "s", Range::at_least(0.0),
                      "second relaxation time, positive if relaxation_2 is positive", false}});
  }

  /// Some stress must remain, and relaxation times must be positive.
  std::optional<BrokenRule> broken_rule() const {
    if constexpr (requires(const Law& law) { law.broken_rule(); }) {
      if (auto broken = Law::broken_rule()) return broken;
    }
    if (!(remaining_share() > 0.0)) {
      return BrokenRule{"relaxation_2", fmt::format("= {} must be below 1 - relaxation_1 = {}", relaxation_2,
                                                    1.0 - relaxation_1)};
    }
    if (relaxation_2 > 0.0 && !(time_2 > 0.0)) {
      return BrokenRule{"time_2",
                        fmt::format("= {} must be positive, as relaxation_2 = {} is", time_2, relaxation_2)};
    }
    return std::nullopt;
  }

  /// g_inf, the share of the isochoric stress that remains.
  constexpr double remaining_share() const { return 1.0 - (relaxation_1 + relaxation_2); }

  /// The law for a step of `seconds`.
  ViscoelasticStep<Law> at_step(double seconds) const {
    return {*this,
            {ViscousStep::of(relaxation_1, time_1, seconds), ViscousStep::of(relaxation_2, time_2, seconds)}};
  }
};

}  // namespace sandglass
