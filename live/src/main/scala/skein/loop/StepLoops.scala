package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.pattern.after
import org.apache.pekko.stream.*
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.{ExecutionContext, Future}
import skein.units.*
import skein.record.EventKind

/** The paper's model 2: read every vehicle one after the other, decide for all, command all, wait one period. */
object SequentialLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using
      system: org.apache.pekko.actor.ActorSystem
  ): RunnableGraph[Future[Done]] =
    import system.dispatcher
    val everyone = team.vehicles.toSet
    val steps    = Source
      .unfoldAsync(Span.Zero)(pause =>
        after(pause.toDuration, system.scheduler)(team.readAll()).map(readings =>
          Some((team.settings.period, readings))
        )
      )
      .collect { case Right(readings) => Percept.Seen(readings, everyone) }
    SnapshotGraph(team, steps.via(stop.flow))

/** The paper's model 3: every period one future per vehicle, which reads all vehicles one after the other, decides for
  * its own and commands it. Futures may overlap; what each decides takes effect in the order in which they finish.
  */
object FuturesLoop:

  def apply(team: Team, stop: SharedKillSwitch)(using ExecutionContext): RunnableGraph[Future[Done]] =
    val steps = Source
      .tick(Span.Zero.toDuration, team.settings.period.toDuration, 1)
      .conflate(_ + _)
      .mapConcat: ticks =>
        if ticks > 1 then
          team.note(EventKind.Skipped, None, s"${ticks - 1} steps missed: too many futures run")
        team.vehicles
      .mapAsyncUnordered(team.settings.window * team.vehicles.size)(vehicle =>
        team.readAll().map(_.map(Percept.Seen(_, Set(vehicle))))
      )
      .collect { case Right(seen) => seen }
    SnapshotGraph(team, steps.via(stop.flow))

/** What `sequential` and `futures` share: each snapshot that they read is decided upon at once. */
private object SnapshotGraph:

  def apply(team: Team, snapshots: Source[Percept, ?]): RunnableGraph[Future[Done]] =
    RunnableGraph.fromGraph(GraphDSL.createGraph(Sink.ignore) { implicit builder => done =>
      import GraphDSL.Implicits.*
      val percepts = builder.add(MergePreferred[Percept](1, eagerComplete = true))
      val everyone = builder.add(Broadcast[Sight](team.vehicles.size))
      val moves    = builder.add(Merge[Move](team.vehicles.size))
      val fed      = builder.add(Broadcast[Move](2))

      for vehicle <- team.vehicles do
        everyone ~> team.decide(vehicle) ~> team.newest(vehicle) ~> team.command(vehicle) ~> moves.in(vehicle)

      snapshots ~> percepts.in(0)
      percepts ~> team.picture ~> everyone
      moves ~> fed ~> team.feedBack ~> percepts.preferred
      fed ~> done
      ClosedShape
    })
