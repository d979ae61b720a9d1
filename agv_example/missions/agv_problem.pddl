(define (problem agv_problem)
  (:domain agv)

  (:objects
    agv1 - robot
    navigate - action
    departure stop1 - stop
    A B C D - place
    C1 C4 C3 C2 - corridor
  )

  (:init
    (robot_at agv1 A)
    (navigate_action navigate)
    (reached departure)
    (stop_at stop1 B)
    (after stop1 departure)
    (connected C1 A B)
    (connected C1 B A)
    (connected C4 A C)
    (connected C4 C A)
    (connected C3 C D)
    (connected C3 D C)
    (connected C2 D B)
    (connected C2 B D)
  )

  (:goal (reached stop1)))
