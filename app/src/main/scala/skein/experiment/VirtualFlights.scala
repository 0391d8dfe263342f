package skein.experiment

import java.nio.file.Path
import java.util.concurrent.Executors
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.flow.{CountedPlanWorkers, PlanWorkers}
import skein.link.{Clock, MemoryNetwork, NetworkPlan}
import skein.loop.PlanSettings
import skein.record.{Digest, MemoryRecorder}
import skein.vtime.VirtualTime

/** Flights in virtual time: the same simulator, link, client and loop as live, with the clock, the scheduler and the
  * sockets replaced. Equal settings and plans give equal recordings, byte for byte.
  */
object VirtualFlights:

  /** Flies all, as many at once as there are cores, and writes a recording of each into `folder`. Blocks.
    *
    * @param onLanded
    *   told of each flight as it has ended, and of its recording's contents
    */
  def fly(settings: FlySettings, plans: Vector[FlightPlan], folder: Path)(
      onLanded: (Landed, Digest) => Unit
  ): Either[String, Vector[Landed]] =
    inParallel(settings, plans): flown =>
      val landed = flown.landed.copy(written = flown.recorder.writeTo(flown.landed.plan.file(folder)))
      onLanded(landed, flown.recorder.digest)
      landed

  /** Flies all, as many at once as there are cores, and keeps of each what `use` makes of it. Blocks. */
  def inParallel[A](settings: FlySettings, plans: Vector[FlightPlan])(
      use: VirtualLanding => A
  ): Either[String, Vector[A]] =
    val threads = Executors.newFixedThreadPool(plans.size.min(Runtime.getRuntime.availableProcessors))
    try
      val flights = plans.map: plan =>
        threads.submit(() => fly(settings, plan).left.map(reason => s"${plan.id}: $reason").map(use))
      val (failed, used) = flights.map(_.get()).partitionMap(identity)
      failed.headOption.toLeft(used)
    finally threads.shutdown()

  /** Flies on the calling thread, to the end.
    *
    * @return
    *   how it ended and what was recorded, or why it could not be flown
    */
  def fly(settings: FlySettings, plan: FlightPlan): Either[String, VirtualLanding] =
    VirtualTime
      .run(plan.seed): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock    = Clock.ofNanos(VirtualTime.clock(system))
        val network  = MemoryNetwork(NetworkPlan(), plan.seed, clock)
        val rigs     = FlightRigs(network.host("localhost"), clock, settings, simulator = None, workers)
        val recorder = MemoryRecorder(rigs.heading(plan, clockKind = "virtual"))
        rigs
          .start(plan, recorder)
          .flatMap:
            case Left(reason) => Future.successful(Left(reason))
            case Right(rig)   => rig.landed.map(landed => Right(VirtualLanding(landed, recorder)))
      .value

  private def workers(planning: PlanSettings): PlanWorkers =
    CountedPlanWorkers(planning.searches, planning.slices)

/** A flight in virtual time and all that was recorded of it. */
final case class VirtualLanding(landed: Landed, recorder: MemoryRecorder)
