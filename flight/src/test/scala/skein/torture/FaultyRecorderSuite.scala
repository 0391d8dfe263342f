package skein.torture

import skein.record.*
import skein.units.*

class FaultyRecorderSuite extends munit.FunSuite:
  private val start = Instant.Epoch + Span.ofSeconds(7)

  private final class Rig(disk: Disk):
    private var now = start
    val memory      = MemoryRecorder(Samples.heading)
    val recorder    = FaultyRecorder(memory, disk, Clock.ofNanos(() => now.toNanos), start)

    /** Offers so many readings at a time since the start. */
    def offer(atMs: Double, readings: Int = 1): Unit =
      now = start + Span.ofMillis(atMs)
      for n <- 1 to readings do recorder.offer(Samples.reading(n))

    def failure: Option[RecordError] = recorder.failure.value.map(_.get)

  test("a sound disk takes all, and so does one that blocks for no more rows than the queue holds"):
    for disk <- Seq(Disk.Sound, Disk.Blocks(Span.ofMillis(100), Span.ofMillis(50), capacity = 3)) do
      val rig = Rig(disk)
      rig.offer(0, 5)
      rig.offer(99, 5)
      rig.offer(100, 2)
      rig.offer(149, 1)
      rig.offer(150, 5)
      rig.offer(1000, 5)
      assertEquals(rig.failure, None, disk.toString)
      assertEquals((rig.memory.records.size, rig.recorder.offered.size), (23, 23), disk.toString)
      assertEquals(rig.recorder.offered, rig.memory.records)

  test(
    "one row more than the queue holds has failed the recording, and what came before is what it must hold"
  ):
    val rig = Rig(Disk.Blocks(Span.ofMillis(100), Span.ofMillis(50), capacity = 3))
    rig.offer(0, 2)
    rig.offer(120, 3)
    assertEquals(rig.failure, None)
    rig.offer(121, 1)
    assertEquals(rig.failure, Some(RecordError.QueueFull(3)))
    rig.offer(500, 4)
    assertEquals((rig.memory.records.size, rig.recorder.offered.size), (5, 5))

  test("a full disk takes nothing from its moment on, but for the word of the flight's end"):
    val rig = Rig(Disk.Fails(Span.ofMillis(100)))
    rig.offer(99, 2)
    assertEquals(rig.failure, None)
    rig.offer(100)
    assert(rig.failure.exists(_.message.contains("the disk is full")), rig.failure.toString)
    val ending = Ending(start, EndingKind.Failed, None)
    rig.recorder.offer(ending)
    assertEquals(rig.memory.records, Vector(Samples.reading(1), Samples.reading(2), ending))
    assertEquals(rig.recorder.offered.size, 2)
