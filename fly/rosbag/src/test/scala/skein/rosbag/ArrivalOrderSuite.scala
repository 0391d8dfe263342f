package skein.rosbag

import scala.collection.mutable
import skein.units.Instant

class ArrivalOrderSuite extends munit.FunSuite:
  private final class Handled:
    val order    = ArrivalOrder()
    val messages = mutable.ArrayBuffer.empty[String]

    def add(at: Long, name: String): Unit = order.add(Instant.ofNanos(at)):
      messages += name

    def upTo(at: Long): Vector[String] =
      order.upTo(Instant.ofNanos(at))
      val all = messages.toVector
      messages.clear()
      all

  test("messages delivered topic by topic are handled in the order of their arrival"):
    val handled = Handled()
    for (at, name) <- Seq(10L -> "a", 30L -> "a2", 20L -> "b", 20L -> "b2", 40L -> "b3") do
      handled.add(at, name)
    assertEquals(handled.upTo(30), Vector("a", "b", "b2", "a2"))
    handled.add(35, "a3")
    assertEquals(handled.upTo(34), Vector.empty)
    assertEquals(handled.upTo(99), Vector("a3", "b3"))

  test("beyond the limit of held messages, the earliest is handled early"):
    val handled = Handled()
    for at <- 0L to ArrivalOrder.MostHeld do handled.add(at, at.toString)
    assertEquals(handled.messages.toVector, Vector("0"))
