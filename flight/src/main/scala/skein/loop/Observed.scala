package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.stream.{FlowShape, Graph, SharedKillSwitch}

/** What [[PredictiveLoop]] and [[PlanLoop]] begin with: every vehicle is sensed, what is told of commands comes back in,
  * and once a period there is a sight of it all.
  *
  * {{{
  * sense(0) ─┐
  * sense(1) ─┤
  * sensors ──┼─ merge ─ picture ─ sight
  * due ──────┤
  * told ─────┘
  * }}}
  */
private object Observed:

  def apply(team: Team, stop: SharedKillSwitch): Graph[FlowShape[Percept, Sight], NotUsed] =
    GraphDSL.create() { implicit builder =>
      import GraphDSL.Implicits.*
      val due      = team.vehicles.size
      val start    = team.now
      val sensed   = team.sensed(start)
      val percepts = builder.add(MergePreferred[Percept](due + 1 + sensed.size, eagerComplete = true))
      val picture  = builder.add(team.pictureWithForecast)

      for vehicle <- team.vehicles do
        StreamLoop.sense(team, vehicle, start, stop).map(Percept.Read(_)) ~> percepts.in(vehicle)
      team.due(start).via(stop.flow) ~> percepts.in(due)
      for (said, sensor) <- sensed.zipWithIndex do said.via(stop.flow) ~> percepts.in(due + 1 + sensor)
      percepts ~> picture
      FlowShape(percepts.preferred, picture.out)
    }
