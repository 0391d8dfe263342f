"""How many raw images the official client takes of four cameras: `image_rate.py PORT SECONDS`."""

import sys
import time
import zlib

import airsim
import numpy

client = airsim.MultirotorClient(port=int(sys.argv[1]))
wanted = [
    airsim.ImageRequest(camera, airsim.ImageType.Scene, False, False)
    for camera in ["front_center", "front_left", "front_right", "bottom_center"]
]
started, images, size, stamps, last, repeated = time.monotonic(), 0, 0, 0, 0, 0
while time.monotonic() - started < float(sys.argv[2]):
    for image in client.simGetImages(wanted):
        pixels = numpy.frombuffer(image.image_data_uint8, numpy.uint8).reshape(image.height, image.width, 3)
        images, size = images + 1, size + pixels.nbytes
        stamps = zlib.crc32(image.time_stamp.to_bytes(8, "big"), stamps)
    repeated, last = repeated + (image.time_stamp <= last), image.time_stamp
spent = time.monotonic() - started
print(
    f"the official Python client, four images a call: {images} came, {repeated} not newer, {images / spent:.1f}/s, "
    f"{size / spent * 1e-9:.2f} GB/s; stamps {stamps:08x}"
)
