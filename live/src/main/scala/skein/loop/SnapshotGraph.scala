package skein.loop

import org.apache.pekko.Done
import org.apache.pekko.stream.ClosedShape
import org.apache.pekko.stream.scaladsl.*
import scala.concurrent.Future

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
