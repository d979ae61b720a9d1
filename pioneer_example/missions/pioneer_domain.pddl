; The Pioneer's mission. (way_clear ?r) and (at_origin ?r) are sensed; (action_feasible ?a) is what the knowledge base says.
(define (domain pioneer)
  (:requirements :strips :typing :durative-actions :negative-preconditions)

  (:types robot action)

  (:predicates
    (at_origin ?r - robot)
    (way_clear ?r - robot)
    (action_feasible ?a - action)
    (go_to_origin_action ?a - action)
    (take_detour_action ?a - action))

  (:durative-action go_to_origin
    :parameters (?a - action ?r - robot)
    :duration (= ?duration 10)
    :condition (and
      (over all (way_clear ?r))
      (over all (go_to_origin_action ?a))
      (over all (action_feasible ?a)))
    :effect (and
      (at end (at_origin ?r))))

  (:durative-action take_detour
    :parameters (?a - action ?r - robot)
    :duration (= ?duration 5)
    :condition (and
      (over all (take_detour_action ?a))
      (over all (action_feasible ?a)))
    :effect (and
      (at end (way_clear ?r)))))
