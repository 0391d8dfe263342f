package skein.search

import java.nio.file.Files
import skein.testing.TemporaryFolders

class NamedFilesSuite extends munit.FunSuite, TemporaryFolders:
  folder.test("a file is found behind any prefixes, also in a link that loses packets first"): folder =>
    val file = Files.writeString(folder.resolve("rtt.txt"), "40")
    for name <- Seq(s"$file", s"file:$file", s"loss:1%,file:$file", s"loss:5%/4,outage:1s/9s,file:$file") do
      val before = NamedFiles.digests(Seq(name))
      assertEquals(before.keySet, Set(s"$file"), name)
      Files.writeString(file, "400")
      assertEquals(NamedFiles.changed(before), Vector(s"$file"), name)
      Files.writeString(file, "40")
    assertEquals(NamedFiles.digests(Seq("vpn", "loss:1%,vpn")), Map.empty)
