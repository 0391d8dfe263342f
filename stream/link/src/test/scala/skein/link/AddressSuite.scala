package skein.link

class AddressSuite extends munit.FunSuite:

  test("a host and a port are parsed and printed, an IPv6 address in brackets"):
    for
      (text, host) <- Seq(
        "127.0.0.1:41451"   -> "127.0.0.1",
        "lab-2:41451"       -> "lab-2",
        "[::1]:41451"       -> "::1",
        "[fe80::1:2]:41451" -> "fe80::1:2"
      )
    do
      val read = Address.parse(text)
      assertEquals(read, Right(Address(host, 41451)))
      assertEquals(read.map(_.toString), Right(text))

  test("an invalid address is refused, and for IPv6 without brackets the correct form is shown"):
    for text <-
        Seq("", "here", ":80", "here:", "here:-1", "[here]:80", "here:80 ")
    do
      assertEquals(
        Address.parse(text),
        Left(s"expected HOST:PORT, for example 127.0.0.1:41451, got '$text'")
      )
    for text <- Seq("here:65536", "[::1]:99999") do
      assertEquals(Address.parse(text), Left(s"expected a port up to 65535, got '$text'"))
    for text <- Seq("::1:41451", "::1", "[::1]", "[::1]41451", "[::1::2]:80", "1:2:3") do
      assertEquals(
        Address.parse(text),
        Left(s"expected HOST:PORT, for example [::1]:41451 of an IPv6 address, got '$text'")
      )
