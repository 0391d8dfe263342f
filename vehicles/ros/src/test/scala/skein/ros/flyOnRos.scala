package skein.ros

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.DurationInt
import scala.concurrent.{Await, Future}
import skein.policy.Action
import skein.units.*

/** Lets the vehicle `a` climb for 3 s under another name, and prints the climb and the age of the last
  * reading. First it looks for a vehicle that does not exist.
  */
@main def flyOnRos(): Unit =
  given system: ActorSystem       = ActorSystem("fly")
  val clock                       = Clock.system
  def await[A](one: Future[A]): A = Await.result(one, 30.seconds)
  println(s"missing: ${await(RosFleet.open(Vector("nowhere"), Nil, clock)).swap.getOrElse("")}")
  val remapped = Seq("/x/odom:=/a/odom", "/x/cmd_vel:=/a/cmd_vel")
  val fleet    =
    await(RosFleet.open(Vector("x"), remapped, clock)).fold(why => throw IllegalStateException(why), identity)
  val vehicle = fleet.vehicles.head
  def read()  = await(vehicle.read()).fold(error => throw IllegalStateException(error.message), identity)
  val from    = read()
  val climbed = await(vehicle.act(Action.Velocity(Vector3(0, 0, -1)), Span.ofSeconds(3)))
  require(climbed == Right(true), climbed)
  val to     = read()
  val clocks = vehicle.clocks.get
  val age    = clocks.ageOf(to, clock.now()).get
  val rise   = from.value.positionNed.z - to.value.positionNed.z
  println(s"climbed $rise ${age.toMillis} ${clocks.uncertainty.toMillis}")
  fleet.close()
  await(system.terminate()): Unit
