(define (problem suave_problem)
  (:domain suave)

  (:objects
    p1 - pipeline
    bluerov - robot
    search_pipeline inspect_pipeline - action)

  (:init
    (search_pipeline_action search_pipeline)
    (inspect_pipeline_action inspect_pipeline))

  (:goal (and
    (pipeline_found p1)
    (pipeline_inspected p1))))
