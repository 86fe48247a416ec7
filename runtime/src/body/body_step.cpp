// SPDX-License-Identifier: Apache-2.0
// The motion of one body, a splitting scheme: half step of velocity, free rotation and translation, half step of velocity.
#include "body/body_math.hpp"

namespace fdcg {
namespace {

constexpr double kLeastStep = 1e-9, kLongestStep = 1;
constexpr double kLargestPush = 1e12;     // N, N m: far beyond any device, and what it does in a step stays finite
constexpr double kLargestTurn_rad = 0.5;  // rad: Newton's method converges from the explicit guess
constexpr uint32_t kMostTurns = 64;       // pieces of a step
constexpr uint32_t kMostIterations = 12;  // four or five do

bool is_push(const double (&v)[3]) {
  return absolute(v[0]) <= kLargestPush && absolute(v[1]) <= kLargestPush && absolute(v[2]) <= kLargestPush;
}

// Solves I w + h/2 w x I w = momentum in the body's axes: w is the angular velocity in the middle of a step of h, momentum the
// angular momentum at its start. Newton's method from w = 0 (its first iterate is the explicit guess), up to rounding error.
// False: no convergence.
bool solve_spin(const Matrix& inertia, Vector momentum, double h, Vector* spin) {
  constexpr double kRounding = 4 * DBL_EPSILON;
  Vector w = {0, 0, 0};
  double last = DBL_MAX;
  for (uint32_t i = 0; i < kMostIterations; ++i) {
    const Vector l = inertia * w;
    const Vector missing = momentum - (l + cross(w, l) * (h / 2));
    // d(w x I w) = w x I dw - I w x dw
    Matrix slope = inertia;
    for (int k = 0; k < 3; ++k) {
      const Vector column = {component(inertia.row[0], k), component(inertia.row[1], k), component(inertia.row[2], k)};
      const Vector unit = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      const Vector change = (cross(w, column) - cross(l, unit)) * (h / 2);
      for (int r = 0; r < 3; ++r) {
        double* const entry = k == 0 ? &slope.row[r].x : k == 1 ? &slope.row[r].y : &slope.row[r].z;
        *entry += component(change, r);
      }
    }
    const Vector step = solve(slope, missing);
    w = w + step;
    const double size = norm(step);
    if (size <= kRounding * norm(w)) {
      *spin = w;
      return true;
    }
    if (i > 1 && size >= last) {  // converged to rounding error, or diverging
      *spin = w;
      return size <= 1e-12 * norm(w);
    }
    last = size;
  }
  return false;
}

// The Cayley update: q (1, h w / 2) made unit.
void turn(double (&q)[4], Vector spin, double h) {
  const double a = spin.x * h / 2, b = spin.y * h / 2, c = spin.z * h / 2;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double next[4] = {x + w * a + y * c - z * b, y + w * b + z * a - x * c, z + w * c + x * b - y * a,
                          w - x * a - y * b - z * c};
  const double scale = 1 / root(next[0] * next[0] + next[1] * next[1] + next[2] * next[2] + next[3] * next[3]);
  for (int k = 0; k < 4; ++k)
    q[k] = next[k] * scale;
}

// Free rotation at constant angular momentum, in parts of at most kLargestTurn_rad.
void turn_freely(fdcg_body* body, double h) {
  const Vector momentum = vec(body->angular_momentum);
  if (momentum.x == 0 && momentum.y == 0 && momentum.z == 0) {
    put({0, 0, 0}, body->spin_rad_per_s);
    return;
  }
  const Matrix inertia = tensor_of(body->config.inertia_kg_m2);
  const double angle = h * norm(solve(inertia, rotation_of(body->rotation_xyzw).transposed_times(momentum)));
  const double wanted = angle / kLargestTurn_rad + 1;
  const uint32_t pieces = wanted < kMostTurns ? static_cast<uint32_t>(wanted) : kMostTurns;
  const double piece = h / pieces;
  bool is_solved = true;
  for (uint32_t i = 0; i < pieces; ++i) {
    const Vector own = rotation_of(body->rotation_xyzw).transposed_times(momentum);
    Vector spin;
    if (!solve_spin(inertia, own, piece, &spin)) {
      spin = solve(inertia, own);
      is_solved = false;
    }
    turn(body->rotation_xyzw, spin, piece);
    put(spin, body->spin_rad_per_s);
  }
  body->unsolved_steps += is_solved ? 0 : 1;
}

// The damping factor of the implicit midpoint rule at this rate: below 1 for any rate and time.
double kept(double rate_per_s, double h) {
  return (1 - rate_per_s * h / 2) / (1 + rate_per_s * h / 2);
}

double radius_of_gyration(const fdcg_body_config& config) {
  const double trace = config.inertia_kg_m2[0] + config.inertia_kg_m2[1] + config.inertia_kg_m2[2];
  return root(trace / (2 * config.mass_kg));
}

// Whether two forces differ by less than the threshold that wakes the body.
bool is_calm(const fdcg_body_config& config, Vector force, Vector torque) {
  const double limit = config.wake_m_per_s2 * config.mass_kg;
  return norm(force) <= limit && norm(torque) <= limit * radius_of_gyration(config);
}

void fall_asleep_when_quiet(fdcg_body* body, Vector force, Vector torque, double h) {
  const fdcg_body_config& config = body->config;
  if (config.sleep_after_s == 0) return;
  const Vector net = force + vec(config.gravity_m_per_s2) * config.mass_kg;
  const bool is_quiet = norm(vec(body->velocity_m_per_s)) <= config.sleep_speed_m_per_s &&
                        norm(vec(body->spin_rad_per_s)) <= config.sleep_turn_rad_per_s && is_calm(config, net, torque);
  body->quiet_s = is_quiet ? body->quiet_s + h : 0;
  if (body->quiet_s < config.sleep_after_s) return;
  body->is_asleep = 1;
  const Vector zero = {0, 0, 0};
  put(zero, body->velocity_m_per_s);
  put(zero, body->angular_momentum);
  put(zero, body->spin_rad_per_s);
  body->has_given = 0;
  put(force, body->rest_force_n);
  put(torque, body->rest_torque_n_m);
}

// The last step applied its forces to its second half in advance (predicted impulse). That is replaced by half of the present
// forces, and half of them is applied in advance for the next step.
void move(fdcg_body* body, Vector force, Vector torque, double h) {
  const fdcg_body_config& config = body->config;
  const Vector half_kick = force * (h / 2), half_twist = torque * (h / 2);
  const Vector fall = vec(config.gravity_m_per_s2) * (h / 2);
  const double kept_speed = kept(config.linear_damping_per_s, h / 2), kept_turn = kept(config.angular_damping_per_s, h / 2);
  const double lightness = 1 / config.mass_kg;
  Vector kick = half_kick, twist = half_twist;
  if (body->has_given != 0) {
    kick = kick + (half_kick - vec(body->predicted_impulse_n_s));
    twist = twist + (half_twist - vec(body->given_n_m_s));
  }
  Vector velocity = vec(body->velocity_m_per_s) + kick * lightness + fall;
  const Vector momentum = vec(body->angular_momentum) + twist;
  velocity = velocity * kept_speed;
  put(momentum * kept_turn, body->angular_momentum);
  put(vec(body->centre_m) + velocity * h, body->centre_m);
  turn_freely(body, h);
  put(velocity * kept_speed + half_kick * lightness + fall, body->velocity_m_per_s);
  put(vec(body->angular_momentum) * kept_turn + half_twist, body->angular_momentum);
  put(half_kick, body->predicted_impulse_n_s);
  put(half_twist, body->given_n_m_s);
  body->has_given = 1;
}

}  // namespace
}  // namespace fdcg

extern "C" void fdcg_body_step(fdcg_body* body, const double force_n[3], const double torque_n_m[3], double dt_s) {
  using namespace fdcg;
  if (body == nullptr) return;
  if (force_n == nullptr || torque_n_m == nullptr) {
    ++body->refused_steps;
    return;
  }
  const double force_given[3] = {force_n[0], force_n[1], force_n[2]};
  const double torque_given[3] = {torque_n_m[0], torque_n_m[1], torque_n_m[2]};
  if (!(body->config.mass_kg > 0) || !(dt_s >= kLeastStep && dt_s <= kLongestStep) || !is_push(force_given) ||
      !is_push(torque_given)) {
    ++body->refused_steps;
    return;
  }
  const Vector force = vec(force_given), torque = vec(torque_given);
  if (body->is_asleep != 0) {
    if (is_calm(body->config, force - vec(body->rest_force_n), torque - vec(body->rest_torque_n_m))) return;
    body->is_asleep = 0;
    body->quiet_s = 0;
  }
  move(body, force, torque, dt_s);
  fall_asleep_when_quiet(body, force, torque, dt_s);
}
