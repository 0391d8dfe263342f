package skein.signal

import skein.units.*

class BandwidthSuite extends munit.FunSuite:

  test("a rate is read with its unit, and its queue is the bytes of 5 ms"):
    assertEquals(Bandwidth.parse("50mbit"), Right(Bandwidth(50_000_000, 31_250)))
    assertEquals(Bandwidth.parse("2.5gbit"), Right(Bandwidth(2_500_000_000L, 1_562_500)))
    assertEquals(Bandwidth.parse("9600bit"), Right(Bandwidth(9600, 3000)))

  test("the text of a rate may state the queue"):
    assertEquals(Bandwidth.parse("50mbit/64kB"), Right(Bandwidth(50_000_000, 64_000)))
    assertEquals(Bandwidth.parse("1mbit/1500B"), Right(Bandwidth(1_000_000, 1500)))
    assertEquals(Bandwidth.parse("1mbit/7.5MB"), Right(Bandwidth(1_000_000, 7_500_000)))

  test("the message about an invalid rate contains the given text"):
    for text <- List(
        "",
        "50",
        "50mb",
        "mbit",
        "-1mbit",
        "0mbit",
        "1bit",
        "200gbit",
        "1mbit/",
        "1mbit/0B",
        "1mbit/1B",
        "1mbit/1499B",
        "1mbit/7.6MB",
        "1kbit/1GB",
        "1mbit/2GB",
        "1mbit/1kb",
        "1e9mbit"
      )
    do
      assertEquals(Bandwidth.parse(text), Left(s"expected ${Bandwidth.form}, got '$text'"))

  test("the time to send bytes is that of their bits"):
    assertEquals(Bandwidth.ofBitsPerSecond(50_000_000).timeOf(6250), Span.ofMillis(1))
