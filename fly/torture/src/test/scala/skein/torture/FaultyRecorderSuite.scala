package skein.torture

import skein.record.*
import skein.units.*

class FaultyRecorderSuite extends munit.FunSuite:
  private val start = Instant.Epoch + Span.ofSeconds(7)

  private final class Assembly(disk: Disk):
    private var now = start
    val memory      = MemoryRecorder(Samples.heading)
    val recorder    = FaultyRecorder(memory, disk, Clock.ofNanos(() => now.toNanos), start)

    /** Offers this number of readings at a time since the start. */
    def offer(atMs: Double, readings: Int = 1): Unit =
      now = start + Span.ofMillis(atMs)
      for n <- 1 to readings do recorder.offer(Samples.reading(n))

    def failure: Option[RecordError] = recorder.failure.value.map(_.get)

  test("a disk without fault, or one that blocks for no more rows than the queue holds, keeps all rows"):
    for disk <- Seq(Disk.Sound, Disk.Blocks(Span.ofMillis(100), Span.ofMillis(50), capacity = 3)) do
      val assembly = Assembly(disk)
      assembly.offer(0, 5)
      assembly.offer(99, 5)
      assembly.offer(100, 2)
      assembly.offer(149, 1)
      assembly.offer(150, 5)
      assembly.offer(1000, 5)
      assertEquals(assembly.failure, None, disk.toString)
      assertEquals((assembly.memory.records.size, assembly.recorder.offered.size), (23, 23), disk.toString)
      assertEquals(assembly.recorder.offered, assembly.memory.records)

  test(
    "one row more than the queue holds fails the recording, which must keep all earlier rows"
  ):
    val assembly = Assembly(Disk.Blocks(Span.ofMillis(100), Span.ofMillis(50), capacity = 3))
    assembly.offer(0, 2)
    assembly.offer(120, 3)
    assertEquals(assembly.failure, None)
    assembly.offer(121, 1)
    assertEquals(assembly.failure, Some(RecordError.QueueFull(3)))
    assembly.offer(500, 4)
    assertEquals((assembly.memory.records.size, assembly.recorder.offered.size), (5, 5))

  test("once the disk is full, nothing more is kept except the flight's end"):
    val assembly = Assembly(Disk.Fails(Span.ofMillis(100)))
    assembly.offer(99, 2)
    assertEquals(assembly.failure, None)
    assembly.offer(100)
    assert(assembly.failure.exists(_.message.contains("the disk is full")), assembly.failure.toString)
    val ending = Ending(start, EndingKind.Failed, None)
    assembly.recorder.offer(ending)
    assertEquals(assembly.memory.records, Vector(Samples.reading(1), Samples.reading(2), ending))
    assertEquals(assembly.recorder.offered.size, 2)
