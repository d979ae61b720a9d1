; The UAV's mission: survey an area, analyse the samples that are found, go home and land (ROSA paper, section 7.4.2).
; (action_feasible ?a) is what the knowledge base says of the action ?a. The other facts are seen by the aircraft: a
; sample may be waiting at any time, and an analysis that was interrupted leaves the gripper unfolded.
(define (domain uav)
  (:requirements :strips :typing :durative-actions :negative-preconditions)

  (:types uav action)

  (:predicates
    (area_searched ?u - uav)
    (sample_waiting ?u - uav)
    (gripper_folded ?u - uav)
    (at_base ?u - uav)
    (landed ?u - uav)
    (action_feasible ?a - action)
    (search_action ?a - action)
    (analyze_action ?a - action)
    (analyze_in_situ_action ?a - action)
    (return_base_action ?a - action)
    (land_fold_action ?a - action))

  (:durative-action search
    :parameters (?a - action ?u - uav)
    :duration (= ?duration 120)
    :condition (and
      (over all (search_action ?a))
      (over all (action_feasible ?a))
      (over all (not (sample_waiting ?u))))
    :effect (and
      (at start (not (landed ?u)))
      (at start (not (at_base ?u)))
      (at end (area_searched ?u))))

  (:durative-action analyze
    :parameters (?a - action ?u - uav)
    :duration (= ?duration 30)
    :condition (and
      (over all (analyze_action ?a))
      (over all (action_feasible ?a))
      (at start (sample_waiting ?u)))
    :effect (and
      (at start (not (landed ?u)))
      (at start (not (at_base ?u)))
      (at end (not (sample_waiting ?u)))))

  ; Only what cannot be picked up is analysed on site, and only with the gripper out of the camera's way.
  (:durative-action analyze_in_situ
    :parameters (?a - action ?better - action ?u - uav)
    :duration (= ?duration 20)
    :condition (and
      (over all (analyze_in_situ_action ?a))
      (over all (action_feasible ?a))
      (over all (gripper_folded ?u))
      (at start (sample_waiting ?u))
      (at start (analyze_action ?better))
      (at start (not (action_feasible ?better))))
    :effect (and
      (at start (not (landed ?u)))
      (at start (not (at_base ?u)))
      (at end (not (sample_waiting ?u)))))

  (:durative-action return_base
    :parameters (?a - action ?s - action ?u - uav)
    :duration (= ?duration 40)
    :condition (and
      (over all (return_base_action ?a))
      (over all (action_feasible ?a))
      (over all (search_action ?s)))
    :effect (and
      (at start (not (landed ?u)))
      (at end (at_base ?u))
      (at end (action_feasible ?s))))

  (:durative-action land_fold
    :parameters (?a - action ?u - uav)
    :duration (= ?duration 15)
    :condition (and
      (over all (land_fold_action ?a))
      (over all (action_feasible ?a)))
    :effect (and
      (at end (landed ?u))
      (at end (gripper_folded ?u)))))
