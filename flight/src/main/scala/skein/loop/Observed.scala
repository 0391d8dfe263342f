package skein.loop

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.*
import org.apache.pekko.stream.{FlowShape, Graph, SharedKillSwitch}

/** What [[PredictiveLoop]] and [[PlanLoop]] begin with: every vehicle is sensed, what is told of commands comes back in,
  * and once a period there is a sight of it all.
  *
  * {{{
  * sense(0) ─┐
  * sense(1) ─┼─ merge ─ picture ─ sight
  * due ──────┤
  * told ─────┘
  * }}}
  */
private object Observed:

  def apply(team: Team, stop: SharedKillSwitch): Graph[FlowShape[Percept, Sight], NotUsed] =
    GraphDSL.create() { implicit builder =>
      import GraphDSL.Implicits.*
      val due      = team.vehicles.size
      val percepts = builder.add(MergePreferred[Percept](due + 1, eagerComplete = true))
      val picture  = builder.add(team.pictureWithForecast)
      val start    = team.now

      for vehicle <- team.vehicles do
        StreamLoop.sense(team, vehicle, start, stop).map(Percept.Read(_, _)) ~> percepts.in(vehicle)
      team.due(start).via(stop.flow) ~> percepts.in(due)
      percepts ~> picture
      FlowShape(percepts.preferred, picture.out)
    }
