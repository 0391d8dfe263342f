package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future

/** The paper's model 4: every operation is a stage of its own. Locations are sensed independently and in
  * order, the latest are joined, each vehicle decides at its own pace on the newest view and is commanded;
  * commands are fed back. No stage waits for another.
  */
object StreamLoop:

  def apply(team: Team, stop: SharedKillSwitch): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => end =>
      import GraphDSL.Implicits.*
      val readings = builder.add(Merge[(Int, Reading)](team.vehicles.size).addAttributes(team.named("merge")))
      val start    = team.now
      val sensed   = team.sensed(start)
      val events   = builder.add(team.events(1 + sensed.size))
      val cast     = builder.add(team.cast())
      val steered  = builder.add(team.steered)
      val fan      = builder.add(team.fan)

      for vehicle <- team.vehicles do
        team.sense(vehicle, start).via(stop.flow).map((vehicle, _)) ~> readings.in(vehicle)
      for vehicle <- team.own do cast ~> pacedDecisions(team, vehicle) ~> team.steer(vehicle) ~> steered

      readings ~> team.joinLatest ~> events.in(0)
      for (said, sensor) <- sensed.zipWithIndex do said.via(stop.flow) ~> events.in(1 + sensor)
      events ~> team.view ~> cast
      steered ~> fan
      fan ~> team.record
      fan ~> team.sent ~> team.feedBack ~> events.preferred
      fan ~> end
      ClosedShape
    })

  private def pacedDecisions(team: Team, vehicle: Int): Flow[DecisionRequest, Decision, ?] =
    if team.settings.decideThenPace then team.decide(vehicle).via(team.pace(vehicle))
    else Flow[DecisionRequest].via(team.pace(vehicle)).via(team.decide(vehicle))
