package skein.vtime

import org.apache.pekko.actor.typed.scaladsl.AskPattern.*
import org.apache.pekko.actor.typed.scaladsl.adapter.*
import org.apache.pekko.actor.typed.scaladsl.{Behaviors, TimerScheduler}
import org.apache.pekko.actor.typed.{ActorRef, ActorSystem, Behavior, SupervisorStrategy}
import org.apache.pekko.util.Timeout
import scala.concurrent.duration.*
import scala.concurrent.{Promise, TimeoutException}

/** Typed actors on a run's classic system. */
class TypedSuite extends munit.FunSuite:
  private case object Beat

  test("timers of typed actors fire on time"):
    val beats = VirtualTime.run(1): system =>
      val promise = Promise[Seq[FiniteDuration]]()
      val clock   = VirtualTime.clock(system)
      val start   = clock()

      def beating(timers: TimerScheduler[Beat.type], seen: Vector[FiniteDuration]): Behavior[Beat.type] =
        Behaviors.receiveMessage: _ =>
          val all = seen :+ (clock() - start).nanos
          if all.size < 3 then
            timers.startSingleTimer(Beat, 250.millis)
            beating(timers, all)
          else
            promise.success(all): Unit
            Behaviors.stopped

      val behavior = Behaviors.withTimers[Beat.type]: timers =>
        timers.startSingleTimer(Beat, 1.second)
        beating(timers, Vector.empty)
      system.spawn(behavior, "beating"): Unit
      promise.future
    assertEquals(beats.value, Seq(1000.millis, 1250.millis, 1500.millis))

  test("an ask of a typed actor times out on time"):
    val run = VirtualTime.run(1): system =>
      given ActorSystem[Nothing] = system.toTyped
      given Timeout              = 3.seconds
      val silent = system.spawn(Behaviors.receiveMessage[ActorRef[Int]](_ => Behaviors.same), "silent")
      silent.ask[Int](identity).failed
    assert(run.value.isInstanceOf[TimeoutException])
    assertEquals(run.duration, 3.seconds)

  test("a typed actor restarts after its seeded back-off"):
    def starts(seed: Long) = VirtualTime.run(seed): system =>
      val promise = Promise[Seq[Long]]()
      val clock   = VirtualTime.clock(system)
      var begun   = Vector.empty[Long]

      val failing = Behaviors.setup[Nothing]: _ =>
        begun = begun :+ clock()
        if begun.size < 4 then throw RuntimeException("down")
        promise.success(begun): Unit
        Behaviors.stopped
      val strategy =
        SupervisorStrategy.restartWithBackoff(100.millis, 1.second, 0.5).withLoggingEnabled(false)
      system.spawn(Behaviors.supervise(failing).onFailure[RuntimeException](strategy), "failing"): Unit
      promise.future
    .value
    val waits = starts(1).sliding(2).map(pair => pair(1) - pair(0)).toSeq
    waits
      .zip(Seq(100, 200, 400))
      .foreach((wait, least) =>
        assert(wait >= least * 1_000_000L && wait <= least * 1_500_000L, s"waited $wait ns")
      )
    assertEquals(starts(1), starts(1))
    assertNotEquals(starts(1), starts(2))
