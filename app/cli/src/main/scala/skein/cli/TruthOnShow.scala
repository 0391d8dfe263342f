package skein.cli

import java.util.concurrent.atomic.AtomicLong
import org.apache.pekko.actor.{ActorSystem, Cancellable}
import scala.concurrent.duration.DurationInt
import skein.record.{RecordingHeader, ReadingRow, VehicleRow}
import skein.signal.Stamped
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.units.*
import skein.vehicle.VehicleKind
import skein.view.{Feed, LiveShow, Shows}

/** Shows a simulator's true vehicle motions to viewers, as readings without latency. */
private[cli] object TruthOnShow:
  private val Every = 50.millis

  /** Starts showing, until the result is cancelled. */
  def start(settings: SimulatorSettings, server: SimulatorServer, shows: Shows, clock: Clock)(using
      system: ActorSystem
  ): Cancellable =
    import system.dispatcher
    val feed     = Feed()
    val sequence = AtomicLong()
    shows.add(LiveShow(heading(settings, server, clock.now()), feed, scene = settings.scene))
    system.scheduler.scheduleWithFixedDelay(Every, Every)(() =>
      server.truth().foreach: truth =>
        val now    = clock.now()
        val number = sequence.getAndIncrement()
        for vehicle <- truth.vehicles do
          feed.offer(ReadingRow(number, vehicle.name, Stamped(vehicle.kinematics, truth.at, now, now)))
    )

  private def heading(settings: SimulatorSettings, server: SimulatorServer, now: Instant) = RecordingHeader(
    LoopOnShow.flight(
      "simulator",
      Span.ofNanos(Every.toNanos),
      server.address.toString,
      "where vehicles truly are",
      now
    ),
    settings.world.vehicles.map(vehicle =>
      VehicleRow(vehicle.name, "", MetresPerSecond(0), vehicle.startNed)
    ),
    settings.world.vehicles.filter(_.isCar).flatMap(car => VehicleRow.kind(car.name, VehicleKind.Car))
  )
