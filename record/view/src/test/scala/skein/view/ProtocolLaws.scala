package skein.view

import java.nio.{ByteBuffer, ByteOrder}
import org.apache.pekko.util.ByteString
import scala.util.Random
import skein.units.Instant

class ProtocolLaws extends munit.FunSuite:

  private def hex(bytes: ByteString): String = bytes.map(byte => f"$byte%02x").mkString(" ")

  test("a data message is its op, the subscription, the time and the payload, little-endian"):
    assertEquals(
      hex(Protocol.messageData(0x01020304, Instant.ofNanos(0x1122334455667788L), ByteString("{}"))),
      "01 04 03 02 01 88 77 66 55 44 33 22 11 7b 7d"
    )

  test("the time and the state of a playback are encoded as the protocol specifies"):
    assertEquals(hex(Protocol.timeIs(Instant.ofNanos(5))), "02 05 00 00 00 00 00 00 00")
    assertEquals(
      hex(
        Protocol.playbackState(Protocol.Playing(
          Protocol.Status.Ended,
          Instant.ofNanos(7),
          2.0,
          seeked = true,
          "ab"
        ))
      ),
      "05 03 07 00 00 00 00 00 00 00 00 00 00 40 01 02 00 00 00 61 62"
    )

  private def playback(command: Int, speed: Float, seek: Option[Long], request: String): ByteString =
    val buffer = ByteBuffer.allocate(19 + request.length).order(ByteOrder.LITTLE_ENDIAN)
    buffer.put(3.toByte).put(command.toByte).putFloat(speed).put((if seek.isDefined then 1 else 0).toByte)
    buffer.putLong(seek.getOrElse(0L)).putInt(request.length).put(request.getBytes("US-ASCII"))
    ByteString(buffer.array)

  test("viewers' messages are read: subscriptions, playback, and unsupported ones"):
    assertEquals(
      Protocol.read(
        """{"op":"subscribe","subscriptions":[{"id":4294967295,"channelId":2},{"id":0,"channelId":1}]}"""
      ),
      Right(ClientMessage.Subscribe(Vector((4294967295L, 2L), (0L, 1L))))
    )
    assertEquals(
      Protocol.read("""{"op":"unsubscribe","subscriptionIds":[3]}"""),
      Right(ClientMessage.Unsubscribe(Vector(3L)))
    )
    assertEquals(
      Protocol.read("""{"op":"getParameters"}"""),
      Right(ClientMessage.NotOffered("getParameters"))
    )
    assertEquals(Protocol.read(ByteString(1, 0, 0)), Right(ClientMessage.NotOffered("binary 1")))
    assertEquals(
      Protocol.read(playback(0, 2.5f, Some(9), "me")),
      Right(ClientMessage.Playback(playing = true, 2.5, Some(Instant.ofNanos(9)), "me"))
    )
    assertEquals(
      Protocol.read(playback(1, 1f, None, "")),
      Right(ClientMessage.Playback(playing = false, 1, None, ""))
    )

  test("invalid messages are refused, with what was expected"):
    for (message, expected) <- Seq(
        "{"                                                                 -> "JSON",
        "[]"                                                                -> "JSON",
        "{}"                                                                -> "JSON",
        """{"op":1}"""                                                      -> "JSON",
        """{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}"""  -> "got -1",
        """{"op":"subscribe","subscriptions":[{"id":1.5,"channelId":1}]}""" -> "got 1.5",
        """{"op":"unsubscribe","subscriptionIds":[4294967296]}"""           -> "got 4.294967296E9",
        "[" * 60_000                                                        -> "JSON",
        """{"op":"subscribe","subscriptions":""" + """{"a":""" * 9_000      -> "JSON"
      )
    do assert(Protocol.read(message).left.exists(_.contains(expected)), message.take(60))
    for (message, expected) <- Seq(
        ByteString.empty                                                      -> "ends at byte 0",
        playback(0, 1f, None, "").dropRight(1)                                -> "ends at byte 18",
        playback(7, 1f, None, "")                                             -> "got 7",
        playback(0, 0f, None, "")                                             -> "got 0.0",
        playback(0, Float.NaN, None, "")                                      -> "got NaN",
        playback(0, 1e9f, None, "")                                           -> "up to 100",
        playback(0, 1f, None, "").dropRight(4) ++ ByteString(-1, -1, -1, 127) -> "256 bytes"
      )
    do assert(Protocol.read(message).left.exists(_.contains(expected)), hex(message))

  test("any bytes of a viewer are read as a message or refused"):
    val random = Random(11)
    val words  = Vector(
      "{",
      "}",
      "[",
      "]",
      "\"op\":",
      "\"subscribe\"",
      "\"subscriptions\":",
      ",",
      "1",
      "-",
      "\"",
      "\\u",
      "e9"
    )
    var refused = 0
    for _ <- 0 until 60_000 do
      val bytes = random.nextBytes(random.nextInt(40))
      val came  = Seq(
        Protocol.read(ByteString(bytes)),
        Protocol.read(String(bytes, "ISO-8859-1")),
        Protocol.read(Seq.fill(random.nextInt(12))(words(random.nextInt(words.size))).mkString)
      ).flatMap(_.left.toOption)
      for reason <- came do assert(reason.nonEmpty && reason.length < 500, reason)
      refused += came.size
    assert(refused > 100_000, refused)
