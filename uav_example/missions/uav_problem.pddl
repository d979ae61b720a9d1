(define (problem uav_problem)
  (:domain uav)

  (:objects
    uav1 - uav
    search analyze analyze_in_situ return_base land_fold - action)

  (:init
    (gripper_folded uav1)
    (at_base uav1)
    (search_action search)
    (analyze_action analyze)
    (analyze_in_situ_action analyze_in_situ)
    (return_base_action return_base)
    (land_fold_action land_fold))

  (:goal (and
    (area_searched uav1)
    (not (sample_waiting uav1))
    (at_base uav1)
    (landed uav1))))
