package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.stream.{FlowShape, Graph, SharedKillSwitch}

/** The common first part of [[PredictiveLoop]] and [[PlanLoop]]: senses every vehicle, feeds command events
  * back, and requests decisions once a period.
  *
  * {{{
  * sense(0) ─┐
  * sense(1) ─┤
  * sensors ──┼─ merge ─ view ─ request
  * due ──────┤
  * told ─────┘
  * }}}
  */
private object Observed:

  def apply(team: Team, stop: SharedKillSwitch): Graph[FlowShape[LoopEvent, DecisionRequest], NotUsed] =
    GraphDSL.create() { implicit builder =>
      import GraphDSL.Implicits.*
      val due    = team.vehicles.size
      val start  = team.now
      val sensed = team.sensed(start)
      val events = builder.add(team.events(due + 1 + sensed.size))
      val view   = builder.add(team.viewWithForecast)

      for vehicle <- team.vehicles do
        team.sense(vehicle, start).via(stop.flow).map(LoopEvent.Read(_)) ~> events.in(vehicle)
      team.due(start).via(stop.flow) ~> events.in(due)
      for (said, sensor) <- sensed.zipWithIndex do said.via(stop.flow) ~> events.in(due + 1 + sensor)
      events ~> view
      FlowShape(events.preferred, view.out)
    }
