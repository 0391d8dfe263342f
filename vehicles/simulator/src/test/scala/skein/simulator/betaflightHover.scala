package skein.simulator

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.link.{ControlThreads, PreciseScheduler}

/** Real firmware flies the simulator's vehicle: Betaflight's SITL in angle mode, with sticks that our
  * controller moves. Prints the vehicle's track, and its distance from its position: `betaflightHover
  * [SECONDS [SPEED]]`.
  */
@main def betaflightHover(arguments: String*): Unit =
  given system: ActorSystem = ActorSystem("betaflight", PreciseScheduler.config)
  val holdsS                = arguments.headOption.fold(30.0)(_.toDouble)
  val speed                 = arguments.lift(1).fold(1.0)(_.toDouble)
  try
    val firmware = Betaflight.firmware()
      .fold(reason => sys.error(s"Betaflight's SITL cannot be built here: $reason"), identity)
    require(Betaflight.arePortsFree, "another program has Betaflight's ports")
    // As in `serve`, once the running code is compiled.
    system.scheduler.scheduleOnce(10.seconds)(ControlThreads.lead(): Unit)(using system.dispatcher): Unit
    val flight = BetaflightFlight.fly(firmware, holdsS, speed)
    println(flight.track)
    println(flight)
  finally
    val _ = Await.result(system.terminate(), 20.seconds)
