package skein.record

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Files
import java.security.MessageDigest
import java.util.HexFormat
import skein.testing.TemporaryFolders

class DigestSuite extends munit.FunSuite, TemporaryFolders:
  private def digest(records: Record*) = Digest.of(records.iterator)

  test("the digest is the SHA-256 of the bytes that its documentation specifies"):
    val bytes               = java.io.ByteArrayOutputStream()
    val out                 = java.io.DataOutputStream(bytes)
    def text(value: String) =
      out.writeByte(1)
      out.writeLong(value.getBytes(UTF_8).length)
      out.write(value.getBytes(UTF_8))
    def whole(value: Long) =
      out.writeByte(2)
      out.writeLong(value)
    def absent() =
      out.writeByte(0)
      out.writeLong(0)
    text("latency")
    whole(0)
    text("vpn·1")
    whole(12)
    out.writeByte(3)
    out.writeDouble(34.5)
    text("command")
    whole(1)
    whole(2)
    text("Pursuer")
    absent()
    for value <- Seq(1.5, -2.5, -20.0) do
      out.writeByte(3)
      out.writeDouble(value)
    whole(99)
    // Absent values of columns that formats before 5 lack are left out, and a list counts as text.
    text("event")
    whole(2)
    whole(5)
    text("DeadlineMissed")
    absent()
    text("late")
    text("plan")
    whole(3)
    text("Pursuer")
    whole(7)
    whole(1024)
    text("3,2")
    absent()
    out.writeByte(3)
    out.writeDouble(1.5)
    whole(0)
    val expected = HexFormat.of.formatHex(MessageDigest.getInstance("SHA-256").digest(bytes.toByteArray))

    import skein.units.*
    val command = CommandRow(
      2,
      "Pursuer",
      None,
      MetresPerSecond(1.5),
      MetresPerSecond(-2.5),
      Metres(-20),
      Instant.ofNanos(99)
    )
    val event   = Event(Instant.ofNanos(5), EventKind.DeadlineMissed, None, "late")
    val planned = Planned("Pursuer", 7, 1024, Vector(3, 2), None, Span.ofMillis(1.5), 0)
    assertEquals(
      digest(Latency("vpn·1", Instant.ofNanos(12), Span.ofMillis(34.5)), command, event, planned),
      Digest(expected)
    )
    assertNotEquals(digest(event.copy(decision = Some(0))), digest(event))

  test("a file has the digest of the records that were written into it"):
    val folder   = temporaryFolder()
    val file     = folder.resolve("flight.duckdb")
    val recorder = MemoryRecorder(Samples.heading)
    Samples.oneOfEach.foreach(recorder.offer)
    try
      assert(recorder.writeTo(file).isRight)
      assertEquals(Digest.ofFile(file), Right(recorder.digest))
    finally
      Files.delete(file)
      Files.delete(folder)

  test("a different value, another order or a missing record changes the digest"):
    val all    = Samples.oneOfEach
    val whole  = digest(all*)
    val others = Seq(
      all.updated(0, Samples.reading(2)),
      all.tail,
      all.reverse,
      all.map:
        case truth: Truth => truth.copy(vehicle = s"${truth.vehicle}2")
        case other        => other
    )
    for other <- others do assertNotEquals(digest(other*), whole)
