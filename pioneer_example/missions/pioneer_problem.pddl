(define (problem pioneer_problem)
  (:domain pioneer)

  (:objects
    p3dx - robot
    go_to_origin take_detour - action)

  (:init
    (go_to_origin_action go_to_origin)
    (take_detour_action take_detour))

  (:goal (at_origin p3dx)))
