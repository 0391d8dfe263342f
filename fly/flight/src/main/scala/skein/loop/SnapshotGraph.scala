package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.{ClosedShape, SharedKillSwitch}
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future

/** The common part of `sequential` and `futures`, also for users' loops: decides on each snapshot
  * immediately.
  *
  * @param snapshots end with the switch
  */
object SnapshotGraph:

  def apply(
      team: Team,
      snapshots: Source[LoopEvent, ?],
      stop: SharedKillSwitch
  ): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => end =>
      import GraphDSL.Implicits.*
      val sensed  = team.sensed(team.now)
      val events  = builder.add(team.events(1 + sensed.size))
      val cast    = builder.add(team.cast())
      val steered = builder.add(team.steered)
      val fan     = builder.add(team.fan)

      // The end overtakes waiting decisions: a vehicle that cannot be commanded accepts none of them.
      for vehicle <- team.own do
        cast ~> team.decide(vehicle) ~> team.newest(vehicle).via(stop.flow) ~>
          team.steer(vehicle) ~> steered

      snapshots.addAttributes(team.named("snapshots")) ~> events.in(0)
      for (said, sensor) <- sensed.zipWithIndex do said.via(stop.flow) ~> events.in(1 + sensor)
      events ~> team.view ~> cast
      steered ~> fan
      fan ~> team.record
      fan ~> team.sent ~> team.feedBack ~> events.preferred
      fan ~> end
      ClosedShape
    })
