package skein.loop

import org.apache.pekko.{Done, NotUsed}
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future
import skein.flow.*
import skein.port.VehicleError
import skein.record.EventKind
import skein.units.*

/** The paper's model 4: every operation its own stage. Locations are sensed independently and in order, the latest
  * are joined, each vehicle decides at its own pace on the newest view and is commanded; what was commanded is fed
  * back. Nothing waits for anything else.
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
        sense(team, vehicle, start, stop).map((vehicle, _)) ~> readings.in(vehicle)
        cast ~> pacedDecisions(team, vehicle) ~> team.steer(vehicle) ~> steered.in(vehicle)

      readings ~> joinLatest(team) ~> events.in(0)
      for (said, sensor) <- sensed.zipWithIndex do said.via(stop.flow) ~> events.in(1 + sensor)
      events ~> team.view ~> cast
      steered ~> fan
      fan ~> team.record
      fan ~> team.sent ~> team.feedBack ~> events.preferred
      fan ~> end
      ClosedShape
    })

  /** All vehicles are asked in phase, as far as the settings do not spread them; a phase of chance between them would make
    * the data of one older than that of the other.
    */
  private[loop] def sense(
      team: Team,
      vehicle: Int,
      start: Instant,
      stop: SharedKillSwitch
  ): Source[Reading, ?] =
    val settings = team.settings
    val offset   = settings.spread * vehicle.toLong / team.vehicles.size.toLong
    Sense
      .at[VehicleError, Reading, NotUsed](
        team.ticks(start + offset),
        settings.window,
        settings.early,
        isNewer = (answered, held) => team.isNewer(answered.state, held.state)
      )(() => team.read(vehicle))(
        onSkip = _.foreach(reading =>
          team.log.note(EventKind.Dropped, Some(vehicle), s"reading ${reading.sequence} overtaken")
        ),
        onMissed =
          ticks => team.log.note(EventKind.Skipped, Some(vehicle), s"$ticks ticks missed: window full")
      )
      .via(stop.flow)
      .addAttributes(team.named("sense", vehicle))

  private[loop] def joinLatest(team: Team): Flow[(Int, Reading), LoopEvent, ?] =
    val everyone = team.vehicles.toSet
    Flow
      .fromGraph(
        JoinLatest[Int, Reading](everyone, team.settings.patience)(
          isNewer = (arrived, held) => team.isNewer(arrived.state, held.state),
          onStale = (vehicle, reading) =>
            team.log.note(EventKind.Dropped, Some(vehicle), s"reading ${reading.sequence} is stale")
        )
      )
      .map(newest => LoopEvent.Seen(newest.values.toVector, everyone))
      .addAttributes(team.named("join latest"))

  private def pacedDecisions(team: Team, vehicle: Int): Flow[DecisionRequest, Decision, ?] =
    if team.settings.decideThenPace then team.decide(vehicle).via(team.pace(vehicle))
    else Flow[DecisionRequest].via(team.pace(vehicle)).via(team.decide(vehicle))
