#!/usr/bin/env python3
# Copyright (c) 2026, the pcl_cosection authors. SPDX-License-Identifier: BSD-3-Clause
"""Train the network of the learned completion: from folders of meshes to an ONNX file."""
import argparse
import math
import os
import shutil
import subprocess
import sys
import threading
import time

import numpy as np
import onnx
import onnx.numpy_helper
import torch
from google.protobuf.message import DecodeError
from torch import nn
from torch.nn import functional

SIZE = 32  # voxels along an edge of the cube, CompletionCube::size
FREE, BEHIND, UNKNOWN = 1, 2, 4  # bits of make_training_samples
SOFT_VOX = 0.4  # a voxel so far inside is occupied with probability 0.73; soft_vox of learned_completion.cpp


class CompletionNetwork(nn.Module):
    """A U-Net over the footprint: heights are channels. Logits of occupancy; their zero is the surface."""

    def __init__(self, widths=(72, 112, 160, 192)):
        super().__init__()
        self.enter = nn.Conv2d(4 * SIZE, widths[0], 1)
        self.down = nn.ModuleList(block(widths[max(0, n - 1)], w) for n, w in enumerate(widths))
        self.up = nn.ModuleList(block(widths[n + 1] + widths[n], widths[n]) for n in (2, 1, 0))
        self.leave = nn.Conv2d(widths[0], SIZE, 1)

    def forward(self, x):
        x = self.enter(x)
        levels = []
        for n, layer in enumerate(self.down):
            x = layer(functional.max_pool2d(x, 2) if n else x)
            levels.append(x)
        for n, layer in enumerate(self.up):
            x = functional.interpolate(x, scale_factor=2.0, mode="nearest")
            x = layer(torch.cat([x, levels[2 - n]], 1))
        return self.leave(x)


def block(inputs, outputs):
    return nn.Sequential(
        nn.Conv2d(inputs, outputs, 3, padding=1, bias=False), nn.BatchNorm2d(outputs), nn.ReLU(True),
        nn.Conv2d(outputs, outputs, 3, padding=1, bias=False), nn.BatchNorm2d(outputs), nn.ReLU(True))


class Samples:
    """The last samples of the generator, which runs beside the training."""

    def __init__(self, program, arguments, seed, kept, uses):
        self.kept, self.uses, self.made, self.used, self.stopped = kept, uses, 0, 0, False
        self.store = np.zeros((kept, 3, SIZE, SIZE, SIZE), np.int8)  # k, j, i
        self.process = subprocess.Popen([program, str(seed), "1000000000"] + arguments, stdout=subprocess.PIPE)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        count = self.store[0].size
        while not self.stopped:
            data = self.process.stdout.read(count)
            if len(data) < count:
                self.stopped = True
                return
            self.store[self.made % self.kept] = np.frombuffer(data, np.int8).reshape(self.store[0].shape)
            self.made += 1
            while self.made > self.kept and self.made > self.used / self.uses + self.kept and not self.stopped:
                time.sleep(0.05)

    def batch(self, rng, count):
        chosen = self.store[rng.integers(0, min(self.made, self.kept), count)]
        if rng.random() < 0.5:
            chosen = chosen[:, :, :, ::-1].copy()  # mirrored across the direction of view
        self.used += count
        return chosen

    def stop(self):
        self.stopped = True
        self.process.kill()


def inputs_of(batch):
    known = torch.from_numpy(batch[:, 1])
    bits = [(known & bit > 0).float() for bit in (FREE, BEHIND, UNKNOWN)]
    observed = torch.cat([torch.from_numpy(batch[:, 0]).float() / 100] + bits, 1)
    return observed.contiguous(memory_format=torch.channels_last)


def loss_of(logits, batch):
    """Cross-entropy with the soft occupancy, and the overlap; what is seen free counts a fifth."""
    distance = torch.from_numpy(batch[:, 2]).float() / 30
    occupied = torch.sigmoid(-distance / SOFT_VOX)
    free = (torch.from_numpy(batch[:, 1]) & FREE > 0).float()
    entropy = functional.binary_cross_entropy_with_logits(logits, occupied, reduction="none") * (1 - 0.8 * free)
    guess, truth = torch.sigmoid(logits) * (1 - free), occupied * (1 - free)
    axes = (1, 2, 3)
    overlap = (2 * (guess * truth).sum(axes) + 1) / ((guess * guess).sum(axes) + (truth * truth).sum(axes) + 1)
    with torch.no_grad():
        hidden = free < 0.5
        a, b = (logits > 0) & hidden, (distance < 0) & hidden
        shared = (((a & b).sum(axes) + 1) / ((a | b).sum(axes) + 1)).mean().item()
    return 4 * entropy.mean() + 0.3 * (1 - overlap).mean(), shared


def load(network, path):
    """Begin with the weights of an ONNX file that export() wrote."""
    weights = {tensor.name: torch.from_numpy(onnx.numpy_helper.to_array(tensor).astype(np.float32))
               for tensor in onnx.load(path).graph.initializer}
    counts = {name: value for name, value in network.state_dict().items() if "num_batches" in name}
    network.load_state_dict({**weights, **counts})


def has_fast_halves():
    """Whether the processor multiplies bfloat16, which makes training twice as fast."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return "avx512_bf16" in file.read()
    except OSError:
        return False


def export(network, path):
    """Write an ONNX file with weights of half precision."""
    network.eval()
    example = torch.zeros(1, 4 * SIZE, SIZE, SIZE)
    torch.onnx.export(network, example, path, opset_version=11, input_names=["observed"], output_names=["occupied"],
                      training=torch.onnx.TrainingMode.PRESERVE, do_constant_folding=False)  # names and layers of PyTorch
    network.train()
    model = onnx.load(path)
    for tensor in model.graph.initializer:
        values = onnx.numpy_helper.to_array(tensor)
        if values.dtype == np.float32:
            tensor.CopyFrom(onnx.numpy_helper.from_array(values.astype(np.float16), tensor.name))
    onnx.save(model, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", help="folders of meshes; random bodies are always there")
    parser.add_argument("-o", "--output", default="completion.onnx", help="the network (%(default)s)")
    parser.add_argument("--generator", default="make_training_samples", help="program that makes samples (%(default)s)")
    parser.add_argument("--minutes", type=float, default=240, help="how long to train in all (%(default)s)")
    parser.add_argument("--exclude", action="append", default=[], help="leave out meshes with this in their name")
    parser.add_argument("--checkpoint", default="completion.pt", help="go on from it if it exists (%(default)s)")
    parser.add_argument("--start", help="network to begin with, an ONNX file of this program")
    parser.add_argument("--threads", type=int, default=1, help="of PyTorch (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the samples and the weights (%(default)s)")
    parser.add_argument("--batch", type=int, default=24, help="samples of a step (%(default)s)")
    parser.add_argument("--report", type=int, default=100, help="steps from one line of progress to the next (%(default)s)")
    parser.add_argument("--rate", type=float, default=1.2e-3, help="highest learning rate (%(default)s)")
    parser.add_argument("--kept", type=int, default=12000, help="samples kept in memory, 100 kB each (%(default)s)")
    options = parser.parse_args()

    if options.minutes <= 0 or options.batch < 1 or options.kept < options.batch or options.report < 1:
        parser.error("--minutes, --batch and --report must be positive, and --kept not less than --batch")
    if shutil.which(options.generator) is None:
        parser.error(f"there is no program {options.generator}: build the target make_training_samples, and name it with "
                     "--generator")

    torch.manual_seed(options.seed)
    torch.set_num_threads(options.threads)
    network = CompletionNetwork().to(memory_format=torch.channels_last)
    if options.start:
        try:
            load(network, options.start)
        except (OSError, RuntimeError, DecodeError) as error:
            parser.error(f"--start {options.start}: {error}")
    average = CompletionNetwork()  # of the weights, which is what is exported
    average.load_state_dict(network.state_dict())
    optimizer = torch.optim.AdamW(network.parameters(), options.rate, weight_decay=1e-4)
    step, spent = 0, 0.0
    if os.path.exists(options.checkpoint):
        saved = torch.load(options.checkpoint)
        network.load_state_dict(saved["network"])
        average.load_state_dict(saved["average"])
        optimizer.load_state_dict(saved["optimizer"])
        step, spent = saved["step"], saved["spent"]

    arguments = [part for name in options.exclude for part in ("--exclude", name)] + options.folders
    samples = Samples(options.generator, arguments, options.seed + 1000 * step, options.kept, uses=5)
    while samples.made < min(20 * options.batch, options.kept) and not samples.stopped:
        time.sleep(0.2)
    if samples.stopped:
        sys.exit("train.py: error: the generator has ended; what it said is above")
    rng = np.random.default_rng(options.seed + step)
    fast_halves = has_fast_halves()
    total, begin, shares, losses = 60 * options.minutes, time.time() - spent, [], []

    def save():
        torch.save({"network": network.state_dict(), "average": average.state_dict(),
                    "optimizer": optimizer.state_dict(), "step": step, "spent": time.time() - begin},
                   options.checkpoint + ".new")
        os.replace(options.checkpoint + ".new", options.checkpoint)
        export(average, options.output)

    while time.time() - begin < total:
        if samples.stopped:
            sys.exit("train.py: error: the generator has ended; what it said is above")
        done = (time.time() - begin) / total
        rate = options.rate * min(1, 50 * done + 0.01) * 0.5 * (1 + math.cos(math.pi * done)) + 1e-6
        for group in optimizer.param_groups:
            group["lr"] = rate
        batch = samples.batch(rng, options.batch)
        with torch.autocast("cpu", torch.bfloat16, enabled=fast_halves):
            logits = network(inputs_of(batch))
        loss, shared = loss_of(logits.float(), batch)
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
        step += 1
        with torch.no_grad():
            keep = min(0.998, step / (step + 10))
            for a, b in zip(average.state_dict().values(), network.state_dict().values()):
                if a.dtype.is_floating_point:
                    a.lerp_(b, 1 - keep)
                else:
                    a.copy_(b)
        shares.append(shared)
        losses.append(loss.item())
        if step % options.report == 0:
            last = slice(-options.report, None)
            print(f"step {step}, {time.time() - begin:.0f} s, {samples.made} samples: loss {np.mean(losses[last]):.4f}, "
                  f"shared volume {np.mean(shares[last]):.4f}, rate {rate:.1e}", flush=True)
        if step % 1000 == 0:
            save()
    save()
    samples.stop()


if __name__ == "__main__":
    main()
