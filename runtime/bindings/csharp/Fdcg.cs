// SPDX-License-Identifier: Apache-2.0
// Made by runtime/bindings/csharp/generate.py from the C headers, which have the documentation: do not edit.
//
// The names and layouts of the C API, in 64-bit processes; libfdcg.so or fdcg.dll must be where the system looks for libraries.
// Frames are right-handed. An engine whose frames are left-handed (Unity) negates the z of positions and forces, and the x and y
// of quaternions, on the way in and out.
using System;
using System.Runtime.InteropServices;

namespace Fdcg {
  public enum fdcg_status {
    FDCG_OK = 0,
    FDCG_E_ARGUMENT,
    FDCG_E_IO,
    FDCG_E_ALIGNMENT,
    FDCG_E_TRUNCATED,
    FDCG_E_MAGIC,
    FDCG_E_VERSION,
    FDCG_E_LAYOUT,
    FDCG_E_CHECKSUM,
    FDCG_E_GRAPH,
    FDCG_E_ABSENT,
    FDCG_E_ARITHMETIC,
    FDCG_E_MESH,
    FDCG_E_MEMORY,
  }

  public enum fdcg_log_level {
    FDCG_LOG_INFO = 0,
    FDCG_LOG_ERROR = 1,
  }

  public enum fdcg_verify {
    FDCG_VERIFY_FULL = 0,
    FDCG_VERIFY_TRUSTED = 1,
    FDCG_VERIFY_SAFE = 2,
  }

  public enum fdcg_state {
    FDCG_FREE = 0,
    FDCG_FACE = 1,
    FDCG_EDGE = 2,
    FDCG_VERTEX = 3,
  }

  public enum fdcg_edge_friction {
    FDCG_EDGE_WEDGE = 0,
    FDCG_EDGE_PAPER = 1,
  }

  public enum fdcg_step_optimization {
    FDCG_STEP_OPT_CLEAR_BALL = 1,
    FDCG_STEP_OPT_HOP = 2,
    FDCG_STEP_OPT_ALL = 3,
  }

  public enum fdcg_friction_flag {
    FDCG_FRICTION_STRIBECK = 1,
    FDCG_FRICTION_VISCOUS = 2,
    FDCG_FRICTION_PRESLIDING = 4,
    FDCG_FRICTION_LAG = 8,
    FDCG_FRICTION_MATERIALS = 16,
    FDCG_FRICTION_FINGER = 32,
    FDCG_FRICTION_SHADING = 64,
    FDCG_FRICTION_ALL = 127,
  }

  public enum fdcg_result_flag {
    FDCG_RESULT_NON_FINITE = 1,
    FDCG_RESULT_TRANSITION_BOUND = 2,
    FDCG_RESULT_SWEEP_BOUND = 4,
    FDCG_RESULT_OTHER_CONTACT = 8,
    FDCG_RESULT_BAD_PARAMS = 16,
    FDCG_RESULT_NOT_OPEN = 32,
    FDCG_RESULT_REFUSED = 56,
  }

  public enum fdcg_contact_event {
    FDCG_EVENT_BEGAN = 1,
    FDCG_EVENT_ENDED = 2,
    FDCG_EVENT_SLIP_BEGAN = 4,
    FDCG_EVENT_SLIP_ENDED = 8,
    FDCG_EVENT_FEATURE = 16,
  }

  public enum fdcg_effect_kind {
    FDCG_EFFECT_OWN = 0,
    FDCG_EFFECT_MAGNET = 1,
    FDCG_EFFECT_VISCOSITY = 2,
    FDCG_EFFECT_STICK_SLIP = 3,
    FDCG_EFFECT_VIBRATION = 4,
    FDCG_EFFECT_NOISE = 5,
    FDCG_EFFECT_TAP = 6,
    FDCG_EFFECT_PULSE = 7,
    FDCG_EFFECT_TEXTURE = 8,
  }

  public enum fdcg_effect_when {
    FDCG_WHEN_TOUCHING = 0,
    FDCG_WHEN_SLIPPING = 1,
    FDCG_WHEN_ALWAYS = 2,
    FDCG_WHEN_TRIGGERED = 3,
  }

  public enum fdcg_effect_along {
    FDCG_ALONG_NORMAL = 0,
    FDCG_ALONG_MOTION = 1,
    FDCG_ALONG_AXIS = 2,
  }

  public enum fdcg_effect_region {
    FDCG_EVERYWHERE = 0,
    FDCG_IN_BALL = 1,
    FDCG_IN_BOX = 2,
  }

  public enum fdcg_wrap {
    FDCG_WRAP_REPEAT = 0,
    FDCG_WRAP_CLAMP = 1,
    FDCG_WRAP_MIRROR = 2,
  }

  public enum fdcg_scene_optimization {
    FDCG_OPT_OUT_OF_REACH = 1,
    FDCG_OPT_FAR_OBJECTS = 2,
    FDCG_OPT_STILL = 4,
    FDCG_OPT_ROTATION = 8,
    FDCG_OPT_RENEWAL = 16,
    FDCG_OPT_ALL = 31,
  }

  public enum fdcg_finger_flag {
    FDCG_FINGER_NON_FINITE = 1,
    FDCG_FINGER_CONTACT_OVERFLOW = 2,
    FDCG_FINGER_MISSED_TICK = 4,
    FDCG_FINGER_BOUNDED = 8,
  }

  public enum fdcg_surface_kind {
    FDCG_SURFACE_PLANE = 0,
    FDCG_SURFACE_SPHERE = 1,
    FDCG_SURFACE_CYLINDER = 2,
    FDCG_SURFACE_CAPSULE = 3,
    FDCG_SURFACE_BOX = 4,
    FDCG_SURFACE_CONE = 5,
    FDCG_SURFACE_TORUS = 6,
    FDCG_SURFACE_ELLIPSOID = 7,
  }

  public enum fdcg_pile_optimization {
    FDCG_PILE_OPT_FAR = 1,
    FDCG_PILE_OPT_STILL = 2,
    FDCG_PILE_OPT_ALL = 3,
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_error {
    public fdcg_status status;
    public ulong offset;
    public fixed byte message[240];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_graph {
    public IntPtr header;
    public IntPtr nodes;
    public uint* node_offsets;
    public IntPtr connections;
    public IntPtr edges;
    public IntPtr corners;
    public IntPtr busy_corners;
    public uint* fans;
    public IntPtr fan_boxes;
    public IntPtr hierarchy;
    public uint* source_map;
    public byte* info;
    public ulong info_bytes;
    public IntPtr mapping;
    public ulong mapping_bytes;
    public ushort* node_materials;
    public IntPtr materials;
    public uint material_count;
    public uint fan_run_count;
    public IntPtr fan_runs;
    public IntPtr normals;
    public fdcg_graph* owner;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_open_options {
    public uint struct_bytes;
    public uint verify;
    public uint populate;
    public uint huge_pages;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_verification {
    public ulong chunks;
    public ulong sides;
    public ulong first_sides;
    public ulong faces;
    public ulong busy_corners;
    public fixed ulong types[4];
    public fixed ulong sums[64];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_node_info {
    public fixed double normal[3];
    public double offset;
    public uint side_count;
    public uint flags;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_side_info {
    public fixed double voronoi_normal[3];
    public double voronoi_offset;
    public uint connection;
    public uint which;
    public uint corner;
    public uint across;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_connection_info {
    public fixed double direction[3];
    public double length;
    public fixed uint corner[2];
    public fixed uint node[2];
    public fixed uint side[2];
    public uint type;
    public uint flatness;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_corner_info {
    public fixed double point[3];
    public fixed double normal[3];
    public uint fan_count;
    public uint is_open;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_mass {
    public double volume_m3;
    public fixed double centroid_m[3];
    public fixed double inertia_per_density_m5[6];
    public double density_kg_per_m3;
    public double mass_kg;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_material {
    public double mu_static;
    public double mu_dynamic;
    public double stiffness_n_per_m;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_params {
    public uint struct_bytes;
    public uint edge_friction;
    public double mu_static;
    public double mu_dynamic;
    public double stiffness_n_per_m;
    public double damping_n_s_per_m;
    public double tick_s;
    public uint disabled_optimizations;
    public uint friction_flags;
    public double stribeck_m_per_s;
    public double viscous_s_per_m;
    public double presliding_n_per_m;
    public double friction_lag_s;
    public double unique_solution_depth_m;
    public fdcg_material finger;
    public fdcg_material* materials;
    public uint material_count;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_contact {
    public fixed double god_object[3];
    public fixed double hip[3];
    public uint started;
    public uint state;
    public uint feature;
    public uint slipping;
    public ulong non_finite_ticks;
    public ulong transition_bound_ticks;
    public ulong sweep_bound_ticks;
    public fixed byte internals[216];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_result {
    public fixed double force_n[3];
    public fixed double god_object_m[3];
    public uint state;
    public uint feature;
    public uint slipping;
    public uint transitions;
    public uint flags;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_visual_vertex {
    public fixed float position[3];
    public uint corner;
    public fixed short normal[4];
    public fixed float uv[2];
    public fixed ushort colour[4];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_visual_material {
    public fixed byte name[64];
    public fixed float base_colour[4];
    public uint first_index;
    public uint index_count;
    public uint flags;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_visual {
    public fdcg_visual_vertex* vertices;
    public uint* indices;
    public uint* nodes;
    public fdcg_visual_material* materials;
    public uint vertex_count;
    public uint index_count;
    public uint material_count;
    public uint reserved;
    public fixed double origin[3];
    public double metres_per_unit;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_surface_hit {
    public uint struct_bytes;
    public uint state;
    public uint feature;
    public uint node;
    public int side;
    public uint reserved;
    public fixed double point_m[3];
    public fixed double normal[3];
    public double distance_m;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_contact_info {
    public uint struct_bytes;
    public uint node;
    public fixed uint corners[3];
    public uint source_face;
    public uint material;
    public uint events;
    public fixed double weights[3];
    public fixed double normal[3];
    public fixed double slip_m_per_s[3];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_texture {
    public double rate_hz;
    public uint order;
    public uint speed_count;
    public uint force_count;
    public uint reserved;
    public double* speed_m_per_s;
    public double* force_n;
    public double* reflection;
    public double* deviation_m_per_s2;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_effect_facts {
    public double tick_s;
    public fixed double hip_m[3];
    public fixed double surface_m[3];
    public fixed double normal[3];
    public fixed double spring_n[3];
    public uint is_touching;
    public uint is_slipping;
    public uint has_surface;
    public uint material;
    public uint node;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_effect_state {
    public uint has_started;
    public uint is_active;
    public uint has_begun;
    public uint is_triggered;
    public fixed double hip_m[3];
    public fixed double way_m[3];
    public fixed double velocity_m_per_s[3];
    public fixed double force_n[3];
    public fixed double normal[3];
    public double time_s;
    public double level;
    public double credit_j;
    public double given_j;
    public fixed double memory[40];
    public ulong random;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_effect {
    public uint struct_bytes;
    public uint kind;
    public uint is_off;
    public uint when;
    public uint along;
    public uint material;
    public uint region;
    public uint seed;
    public IntPtr law;
    public IntPtr context;
    public fdcg_texture* texture;
    public fixed double region_m[3];
    public fixed double region_half_m[3];
    public fixed double axis[3];
    public double force_n;
    public double distance_m;
    public double viscosity_n_s_per_m;
    public double stiffness_n_per_m;
    public double frequency_hz;
    public double low_hz;
    public double impact_n_s_per_m;
    public double decay_s;
    public double duration_s;
    public double period_s;
    public double mass_kg;
    public double smoothing_s;
    public double ramp_s;
    public double reserve_j;
    public double power_w;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_relief_place {
    public fixed double place_m[3];
    public fixed double way_m[3];
    public uint node;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_waves {
    public uint count;
    public uint reserved;
    public fixed double per_m[48];
    public fixed double amplitude_m[16];
    public fixed double phase_turns[16];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_relief {
    public uint struct_bytes;
    public uint is_off;
    public uint material;
    public uint reserved;
    public IntPtr law;
    public IntPtr data;
    public double most_m;
    public double curvature_per_m;
    public double reserve_j;
    public double power_w;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_relief_state {
    public uint has_started;
    public uint has_surface;
    public uint node;
    public uint reserved;
    public fixed double hip_m[3];
    public fixed double moved_m[3];
    public fixed double surface_m[3];
    public fixed double normal[3];
    public fixed double slope[3];
    public fixed double force_n[3];
    public fixed double flat_n[3];
    public double height_m;
    public double credit_j;
    public double given_j;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_node_place {
    public fixed double offset[2];
    public fixed float per_unit[6];
    public uint map;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_height_map {
    public double metres_per_step;
    public uint width;
    public uint height;
    public uint level_count;
    public uint first;
    public fixed uint wrap[2];
    public fixed uint reserved[2];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_heights {
    public fdcg_node_place* places;
    public fdcg_height_map* maps;
    public short* texels;
    public uint node_count;
    public uint map_count;
    public fixed double origin[3];
    public double metres_per_unit;
    public double most_m;
    public double curvature_per_m;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_object_id {
    public uint index;
    public uint generation;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_finger_id {
    public uint index;
    public uint generation;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_pose {
    public fixed double rotation_xyzw[4];
    public fixed double translation_m[3];
    public double scale;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_scene_config {
    public uint struct_bytes;
    public uint object_capacity;
    public uint finger_capacity;
    public uint touches_per_finger;
    public uint disabled_optimizations;
    public uint has_soft_fingers;
    public uint has_deforms;
    public uint material_capacity;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_touch {
    public fdcg_object_id @object;
    public fixed double force_n[3];
    public fixed double god_object_m[3];
    public uint state;
    public uint feature;
    public uint slipping;
    public uint transitions;
    public uint flags;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_finger_result {
    public fixed double force_n[3];
    public uint flags;
    public uint touch_count;
    public fdcg_touch* touches;
    public ulong non_finite_steps;
    public ulong overflowed_steps;
    public ulong missed_ticks;
    public ulong broadphase_updates;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_reaction {
    public fixed double force_n[3];
    public fixed double torque_n_m[3];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_surface {
    public uint struct_bytes;
    public uint kind;
    public uint is_hollow;
    public uint reserved;
    public double radius_m;
    public double top_radius_m;
    public double tube_radius_m;
    public double length_m;
    public fixed double half_m[3];
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_body_config {
    public uint struct_bytes;
    public uint reserved;
    public double mass_kg;
    public fixed double centre_m[3];
    public fixed double inertia_kg_m2[6];
    public fixed double gravity_m_per_s2[3];
    public double linear_damping_per_s;
    public double angular_damping_per_s;
    public double sleep_after_s;
    public double sleep_speed_m_per_s;
    public double sleep_turn_rad_per_s;
    public double wake_m_per_s2;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_body {
    public fdcg_body_config config;
    public fixed double rotation_xyzw[4];
    public fixed double centre_m[3];
    public fixed double velocity_m_per_s[3];
    public fixed double angular_momentum[3];
    public fixed double spin_rad_per_s[3];
    public fixed double predicted_impulse_n_s[3];
    public fixed double given_n_m_s[3];
    public fixed double rest_force_n[3];
    public fixed double rest_torque_n_m[3];
    public fixed double push_n[3];
    public fixed double push_n_m[3];
    public double quiet_s;
    public double scale;
    public uint is_asleep;
    public uint has_given;
    public ulong refused_steps;
    public ulong unsolved_steps;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_scene_body {
    public fdcg_object_id @object;
    public fdcg_body body;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_pile_config {
    public uint struct_bytes;
    public uint object_capacity;
    public uint point_capacity;
    public uint touch_capacity;
    public double damping_ratio;
    public double leaving_ratio;
    public uint disabled_optimizations;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_pile_touch {
    public fdcg_object_id @object;
    public fdcg_object_id on;
    public fixed double force_n[3];
    public fixed double god_object_m[3];
    public fixed double normal[3];
    public double load_n;
    public double stiffness_n_per_m;
    public uint point;
    public uint state;
    public uint feature;
    public uint slipping;
    public uint softened;
    public uint reserved;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_pile_counts {
    public ulong overflowed_contacts;
    public ulong broadphase_updates;
    public ulong steps;
    public ulong softened_steps;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_deform_config {
    public uint struct_bytes;
    public uint reserved;
    public double margin_m;
  }

  [StructLayout(LayoutKind.Sequential)]
  public unsafe struct fdcg_deform_contact {
    public fdcg_contact contact;
    public double travel;
    public ulong tick;
    public uint halvings;
    public uint ball;
  }

  public static unsafe class Native {
    const string Library = "fdcg";
    public const uint FDCG_NONE = 0xFFFFFFFF;

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_version();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr fdcg_status_text(fdcg_status status);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_set_log_handler(IntPtr handler, IntPtr context);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_set_assert_handler(IntPtr handler, IntPtr context);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_open_memory(IntPtr data, ulong bytes, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_open_trusted(IntPtr data, ulong bytes, fdcg_graph* graph, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_open_file([MarshalAs(UnmanagedType.LPStr)] string path, fdcg_verify verify, fdcg_graph* graph, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_open_options_init(fdcg_open_options* options, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_open_options fdcg_make_open_options();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_open_file_with([MarshalAs(UnmanagedType.LPStr)] string path, fdcg_open_options* options, fdcg_graph* graph, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_close(fdcg_graph* graph);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_move_graph(fdcg_graph* from, fdcg_graph* to, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_warm(fdcg_graph* graph);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_verify_chunk_count(fdcg_graph* graph);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_verify_chunk(fdcg_graph* graph, fdcg_verify level, uint chunk, fdcg_verification* part, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_verify_sum(fdcg_graph* graph, fdcg_verify level, fdcg_verification* parts, uint count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_node_info fdcg_get_node(fdcg_graph* graph, uint node);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_side_info fdcg_get_side(fdcg_graph* graph, uint node, uint side);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_connection_info fdcg_get_connection(fdcg_graph* graph, uint connection);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_corner_info fdcg_get_corner(fdcg_graph* graph, uint corner);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_get_node_normals(fdcg_graph* graph, uint node, double* normals);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_get_fan(fdcg_graph* graph, uint corner, uint* entries, uint capacity);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_mass(fdcg_graph* graph, fdcg_mass* mass, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_get_node_material(fdcg_graph* graph, uint node);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr fdcg_get_material_name(fdcg_graph* graph, uint material);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_find_material(fdcg_graph* graph, [MarshalAs(UnmanagedType.LPStr)] string name);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern ulong fdcg_checksum(IntPtr data, ulong bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_material fdcg_combine_materials(fdcg_material* surface, fdcg_material* finger);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_params_init(fdcg_params* @params, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_params fdcg_make_params();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_check_params(fdcg_params* @params, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_step(fdcg_graph* graph, fdcg_params* @params, fdcg_contact* contact, double* hip_object_m, fdcg_result* result);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_visual(fdcg_graph* graph, fdcg_visual* visual, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_surface_hit_init(fdcg_surface_hit* hit, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface_hit fdcg_make_surface_hit();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_find_nearest(fdcg_graph* graph, double* point_object_m, double reach_m, fdcg_surface_hit* hit, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_signed_distance(fdcg_graph* graph, double* point_object_m, double* distance_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_is_inside(fdcg_graph* graph, double* point_object_m, int* is_inside, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_cast_ray(fdcg_graph* graph, double* from_object_m, double* direction, double reach_m, fdcg_surface_hit* hit, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_contact_info_init(fdcg_contact_info* info, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_contact_info fdcg_make_contact_info();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_contact_info(fdcg_graph* graph, uint* source_of_node, fdcg_result* before, fdcg_result* now, double tick_s, fdcg_contact_info* info, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_invert_source_map(fdcg_graph* graph, uint* source_of_node, uint count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_get_contact_events(fdcg_result* before, fdcg_result* now);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_step_path(fdcg_graph* graph, fdcg_params* @params, fdcg_contact* contact, double* hips_object_m, fdcg_result* results, ulong count);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_step_many(fdcg_graph* graph, fdcg_params* @params, fdcg_contact* contacts, double* hips_object_m, fdcg_result* results, ulong count);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_reflection(double* coefficients, uint order, double* reflection, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_effect_init(fdcg_effect* effect, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_magnet_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_viscosity_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_stick_slip_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_vibration_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_noise_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_tap_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_pulse_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_texture_law(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_magnet(double force_n, double distance_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_viscosity(double viscosity_n_s_per_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_stick_slip(double stiffness_n_per_m, double force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_vibration(double force_n, double frequency_hz);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_noise(double force_n, double low_hz, double high_hz);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_tap(double impact_n_s_per_m, double frequency_hz, double decay_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_pulse(double force_n, double duration_s, double period_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_texture(fdcg_texture* texture, double mass_kg);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_effect fdcg_make_own_effect(IntPtr law, IntPtr context, double force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_check_effect(fdcg_effect* effect, double tick_s, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern double fdcg_get_effect_stiffness(fdcg_effect* effect, double tick_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_effect_facts(fdcg_graph* graph, fdcg_result* result, double* hip_object_m, double reach_m, double tick_s, fdcg_effect_facts* facts, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_effect_step(fdcg_effect* effect, fdcg_effect_facts* facts, fdcg_effect_state* state, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_trigger_effect(fdcg_effect_state* state);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_waves fdcg_make_ridges(double amplitude_m, double wavelength_m, double* direction);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_waves fdcg_make_bumps(double amplitude_m, double wavelength_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_waves fdcg_make_grain(double rms_m, double shortest_m, double longest_m, double exponent, uint seed);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_relief_init(fdcg_relief* relief, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_waves_law(fdcg_relief* relief, fdcg_relief_place* place, double* height_m, double* slope);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_get_waves_bounds(fdcg_waves* waves, double* most_m, double* curvature_per_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_relief fdcg_make_relief(fdcg_waves* waves);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_check_relief(fdcg_relief* relief, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern double fdcg_get_relief_stiffness(fdcg_relief* relief, double load_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_relief_move(fdcg_relief* relief, fdcg_relief_state* state, double* hip_m, double tick_s, double* moved_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_relief_turn(fdcg_relief* relief, fdcg_relief_state* state, fdcg_effect_facts* facts, double* force_n);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_get_heights(fdcg_graph* graph, fdcg_heights* heights, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_heights_law(fdcg_relief* relief, fdcg_relief_place* place, double* height_m, double* slope);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_relief fdcg_make_height_relief(fdcg_heights* heights);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_pose fdcg_make_identity_pose();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_scene_config_init(fdcg_scene_config* config, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_scene_config fdcg_make_scene_config();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern ulong fdcg_scene_bytes(fdcg_scene_config* config);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_create(IntPtr memory, ulong bytes, fdcg_scene_config* config, IntPtr* scene, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_add_object(IntPtr scene, fdcg_graph* graph, fdcg_params* @params, fdcg_pose* pose, fdcg_object_id* @object, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_remove_object(IntPtr scene, fdcg_object_id @object, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_set_pose(IntPtr scene, fdcg_object_id @object, fdcg_pose* pose, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_set_params(IntPtr scene, fdcg_object_id @object, fdcg_params* @params, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_replace_graph(IntPtr scene, fdcg_object_id @object, fdcg_graph* graph, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_enable_object(IntPtr scene, fdcg_object_id @object, int is_enabled, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_add_finger(IntPtr scene, double* hip_world_m, fdcg_finger_id* finger, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_remove_finger(IntPtr scene, fdcg_finger_id finger, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_move_finger(IntPtr scene, fdcg_finger_id finger, double* hip_world_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_set_finger_material(IntPtr scene, fdcg_finger_id finger, fdcg_material* material, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_reset_finger(IntPtr scene, fdcg_finger_id finger, double* hip_world_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_scene_step(IntPtr scene);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_scene_advance(IntPtr scene);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_step_finger(IntPtr scene, fdcg_finger_id finger, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_get_result(IntPtr scene, fdcg_finger_id finger, fdcg_finger_result* result, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_scene_get_reactions(IntPtr scene, fdcg_reaction* reactions, uint count);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern ulong fdcg_scene_state_bytes(IntPtr scene);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_save(IntPtr scene, IntPtr state, ulong bytes, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_restore(IntPtr scene, IntPtr state, ulong bytes, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_surface_init(fdcg_surface* surface, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_linked_surface(uint linked_kind, double radius_m, double length_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_surface(fdcg_surface_kind kind, double radius_m, double length_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_plane();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_sphere(double radius_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_cylinder(double radius_m, double length_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_capsule(double radius_m, double length_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_cone(double radius_m, double top_radius_m, double length_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_torus(double radius_m, double tube_radius_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_box(double half_x_m, double half_y_m, double half_z_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_surface fdcg_make_ellipsoid(double half_x_m, double half_y_m, double half_z_m);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_check_surface(fdcg_surface* surface, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_surface_step(fdcg_surface* surface, fdcg_params* @params, fdcg_contact* contact, double* hip_object_m, fdcg_result* result);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_surface_get_normal(fdcg_surface* surface, fdcg_result* result, double* normal);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_surface_get_mass(fdcg_surface* surface, fdcg_mass* mass, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_add_surface(IntPtr scene, fdcg_surface* surface, fdcg_params* @params, fdcg_pose* pose, fdcg_object_id* @object, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_set_finger_radius(IntPtr scene, fdcg_finger_id finger, double radius_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_set_finger_rotation(IntPtr scene, fdcg_finger_id finger, double* rotation_xyzw, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_get_finger_torque(IntPtr scene, fdcg_finger_id finger, double* torque_n_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_body_config_init(fdcg_body_config* config, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_body_config fdcg_make_body_config();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_body_set_mass(fdcg_body_config* config, fdcg_mass* mass, double density_kg_per_m3, double scale, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_body_init(fdcg_body* body, fdcg_body_config* config, fdcg_pose* pose, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_body_set_motion(fdcg_body* body, double* velocity_m_per_s, double* angular_rad_per_s, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_body_set_push(fdcg_body* body, double* force_n, double* torque_n_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_body_step(fdcg_body* body, double* force_n, double* torque_n_m, double dt_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_pose fdcg_body_get_pose(fdcg_body* body);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_body_get_angular_velocity(fdcg_body* body, double* angular_rad_per_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern double fdcg_body_get_kinetic_energy_j(fdcg_body* body);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_body_get_substeps(fdcg_body* body, double stiffness_n_per_m, double reach_m, double tick_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_step_bodies(IntPtr scene, fdcg_scene_body* bodies, uint body_count, uint substeps, double tick_s, fdcg_reaction* reactions, uint reaction_count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_pile_config_init(fdcg_pile_config* config, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_pile_config fdcg_make_pile_config();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern ulong fdcg_pile_bytes(fdcg_pile_config* config);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_pile_create(IntPtr memory, ulong bytes, fdcg_pile_config* config, IntPtr* pile, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_pile_set_ground(IntPtr pile, double* normal, double offset_m, fdcg_params* @params, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_pile_add(IntPtr pile, IntPtr scene, fdcg_object_id @object, double* points_m, uint point_count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_pile_remove(IntPtr pile, fdcg_object_id @object, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_pick_points(fdcg_graph* graph, double* points_m, uint capacity, uint* count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_step_pile(IntPtr scene, IntPtr pile, fdcg_scene_body* bodies, uint body_count, uint substeps, double tick_s, fdcg_reaction* reactions, uint reaction_count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_pile_get_substeps(IntPtr pile, IntPtr scene, fdcg_scene_body* bodies, uint body_count, double tick_s);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint fdcg_pile_get_touches(IntPtr pile, fdcg_pile_touch* touches, uint capacity);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_pile_counts fdcg_pile_get_counts(IntPtr pile);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_deform_config_init(fdcg_deform_config* config, uint struct_bytes);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_deform_config fdcg_make_deform_config();

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern ulong fdcg_deform_bytes(fdcg_graph* graph);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_create(IntPtr memory, ulong bytes, fdcg_graph* graph, fdcg_deform_config* config, IntPtr* deform, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_find(IntPtr deform, double* position_object_m, uint* corner, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_move(IntPtr deform, uint corner, double* position_object_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_move_corners(IntPtr deform, uint* corners, double* positions_object_m, ulong count, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_place(IntPtr deform, uint corner, double* position_object_m, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern void fdcg_deform_step(IntPtr deform, fdcg_params* @params, fdcg_deform_contact* contact, double* hip_object_m, fdcg_result* result);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_deform_share(IntPtr deform, fdcg_result* result, uint* corners, double* weights, fdcg_error* error);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_graph* fdcg_deform_get_graph(IntPtr deform);

    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern fdcg_status fdcg_scene_add_deform(IntPtr scene, IntPtr deform, fdcg_params* @params, fdcg_pose* pose, fdcg_object_id* @object, fdcg_error* error);
  }
}
