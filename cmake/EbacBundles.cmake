# Files that are compiled together, because they share headers and templates. Chosen so that two cores finish
# at the same time and no compiler needs more than 1.2 GB, but under sanitizers; `.ci/compile_time` measures both.
# Under a sanitizer, where little or nothing is optimised, most of the work is to read headers: all files of the library
# but those of the model are one bundle.
function(ebac_bundle target name folder)
  if(EBAC_SANITIZE AND target MATCHES "^ebac")
    set(target ebac)
    if(NOT name STREQUAL "model")
      set(name rest)
    endif()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    set_source_files_properties(${folder}/${source}.cpp PROPERTIES UNITY_GROUP ${name})
  endforeach()
endfunction()

ebac_bundle(ebac_tick tick cpp/ebac control/laws gastroscope/procedure sim/any_law sim/ebac_loop sim/simulated_device)
# Apart from the tick, which would take their functions into its own (gnu::flatten).
ebac_bundle(ebac_tick stages cpp/ebac control/turned_ports loop/axis_observer loop/plausibility loop/safety_limiter
            loop/signal_chain loop/state_observer model/environment model/port_space)
ebac_bundle(ebac model cpp/ebac core/matrix_exponential model/device model/exact_axis model/exact_plant model/hand model/hand_model model/joint_dynamics
            model/kinematics model/limits model/linear_flow model/stepped_plant world/engine/engine_client
            world/engine/make_bridge world/engine/shared_channel world/make)
ebac_bundle(ebac machine cpp/ebac can/raw_socket can/socketcan can/wake_event
            canopen/canopen_setup canopen/eds canopen/loop_watch canopen/pdo canopen/pdo_plan
            rt/awake_cpus rt/grants rt/jitter rt/other_process rt/shared_memory rt/thread
            sensor/emulator_server sensor/rdt_client sensor/udp sim/linear_loop
            simulated_drives/simulated_drive simulated_drives/simulated_drive_errors
            simulated_drives/simulated_drive_motion simulated_drives/simulated_drive_objects
            simulated_drives/simulated_wire simulated_drives/through_can)
ebac_bundle(ebac teleop cpp/ebac gastroscope/bending gastroscope/driven_scope gastroscope/lumen gastroscope/physician
            gastroscope/slave gastroscope/tube remote/link_end remote/slave_worlds teleop/packet teleop/simulate
            teleop/udp_sides)
ebac_bundle(ebac run cpp/ebac control/virtual_coupling core/check core/fields faults/campaign faults/case
            faults/case_setup faults/referee faults/test_bench identify/arm_drive identify/arm_jacobian identify/arm_record identify/arm_step identify/arm_trials loop/retune loop/trace sim/contact sim/ideal_wall
            sim/perceived_ripple sim/rest_power sim/sweep)

if(EBAC_PYTHON)
  ebac_bundle(_core_values device bindings core device fields hand kinematics limits module values)
  ebac_bundle(_core_values world bindings engine_process engines environment remote worlds)
  ebac_bundle(_core_values body bindings gastroscope identify linear_loop sweep)
  ebac_bundle(_core_values run bindings controllers python_hand python_law realtime replay simulation teleop teleop_udp)
  ebac_bundle(_core_values bus bindings can can_plan faults running)
  ebac_bundle(_core_values machine bindings drive node_server others_run sensor sensor_emulator)
  ebac_bundle(_core loop bindings law_runs running_laws stepped_run)
endif()
