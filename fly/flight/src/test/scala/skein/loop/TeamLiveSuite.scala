package skein.loop

import java.util.concurrent.{CountDownLatch, Executors}
import scala.concurrent.duration.*
import scala.concurrent.{Await, ExecutionContext, Future}
import skein.port.{VehicleError, VehiclePort}
import skein.scenario.PaperDuel
import skein.testing.Unhurried
import skein.units.Clock
import skein.policy.Action
import skein.record.{MemoryRecorder, Samples}
import skein.signal.{Kinematics, Stamped}
import skein.units.*

class TeamLiveSuite extends munit.FunSuite, Unhurried:

  /** A vehicle that answers only when the test requests it. */
  private final class Slow extends VehiclePort:
    @volatile var answers = false
    private val here      = Kinematics(Vector3.Zero, Vector3.Zero, Quaternion.Identity, Vector3.Zero)

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      if answers then Future.successful(Right(Stamped(here, Instant.Epoch, Instant.Epoch, Instant.Epoch)))
      else Future.never
    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      Future.successful(Right(true))
    def hover(): Future[Either[VehicleError, Boolean]] = Future.successful(Right(true))

  test("simultaneous readings of one vehicle by several threads have distinct numbers"):
    // Enough for simultaneous requests even on a busy machine.
    val (threads, each)    = (4, 3_000_000)
    val pool               = Executors.newFixedThreadPool(threads)
    given ExecutionContext = ExecutionContext.fromExecutor(pool)
    val port               = Slow()
    val team               = Team(
      PaperDuel().fleet,
      Vector(port, port),
      Clock.system,
      MemoryRecorder(Samples.heading),
      LoopSettings()
    )
    val together = CountDownLatch(threads)
    try
      val asking = Future.traverse(Vector.range(0, threads)): _ =>
        Future:
          together.countDown()
          together.await()
          for _ <- 1 to each do team.read(vehicle = 1): Unit
      Await.result(asking, 60.seconds): Unit
      port.answers = true
      val next = Await.result(team.read(vehicle = 1), 60.seconds)
      assertEquals(next.map(_.sequence), Right(threads * each.toLong))
    finally pool.shutdown()
