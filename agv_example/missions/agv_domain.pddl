; The AGV's mission: to one stop after the other, corridor by corridor (ROSA paper, section 7.4.1).
; (action_feasible ?a) is what the knowledge base says of the action ?a. (best_way ?s ?c ?to) is what the co-adaptive
; planner says: the best way to the stop ?s leads through the corridor ?c to the place ?to. Where the robot is it sees
; for itself; in a corridor it counts as still at the place from which it came.
(define (domain agv)
  (:requirements :strips :typing :durative-actions)

  (:types robot place corridor stop action)

  (:predicates
    (robot_at ?r - robot ?p - place)
    (connected ?c - corridor ?from ?to - place)
    (best_way ?s - stop ?c - corridor ?to - place)
    (stop_at ?s - stop ?p - place)
    (after ?s ?before - stop)
    (reached ?s - stop)
    (action_feasible ?a - action)
    (navigate_action ?a - action))

  (:durative-action navigate
    :parameters (?a - action ?r - robot ?before ?s - stop ?c - corridor ?from ?to - place)
    :duration (= ?duration 60)
    :condition (and
      (over all (navigate_action ?a))
      (over all (action_feasible ?a))
      (over all (after ?s ?before))
      (over all (connected ?c ?from ?to))
      (over all (best_way ?s ?c ?to))
      (at start (reached ?before))
      (at start (robot_at ?r ?from)))
    :effect (and
      (at end (not (robot_at ?r ?from)))
      (at end (robot_at ?r ?to))))

  (:durative-action arrive
    :parameters (?r - robot ?before ?s - stop ?p - place)
    :duration (= ?duration 1)
    :condition (and
      (over all (after ?s ?before))
      (over all (stop_at ?s ?p))
      (over all (robot_at ?r ?p))
      (at start (reached ?before)))
    :effect (at end (reached ?s))))
